#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

namespace nsma::app {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::clear() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
    drawn_ = false;
}

void Progress::show(long done, long total) {
    if (quiet_ || total <= 0) return;
    const auto now = Clock::now();
    const std::chrono::duration<double> since = now - last_;
    if (since.count() < (terminal_ ? 0.1 : 10.0)) return;
    last_ = now;
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    const double rate = static_cast<double>(done) / elapsed;
    const double share = static_cast<double>(done) / static_cast<double>(total);
    const double left = rate > 0 ? static_cast<double>(total - done) / rate : 0.0;
    const std::string figures =
        fmt::format("{}/{} ({:.0f} %), {:.1f}/s, {:.0f} s left", done, total, 100 * share, rate, left);
    if (terminal_) {
        constexpr int width = 24;
        const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * width);
        const std::string bar = std::string(full, '#') + std::string(width - full, '.');
        fmt::print(stderr, "\r\x1b[K{} [{}] {}", what_, bar, figures);
        drawn_ = true;
    } else {
        fmt::print(stderr, "{}: {}\n", what_, figures);
    }
    std::fflush(stderr);
}

}  // namespace nsma::app
