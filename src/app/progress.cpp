#include "progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace nsma::app {
namespace {

std::string time_text(double seconds) {
    if (seconds < 120) return fmt::format("{:.0f} s", seconds);
    return seconds < 7200 ? fmt::format("{:.0f} min", seconds / 60) : fmt::format("{:.0f} h", seconds / 3600);
}

}  // namespace

Progress::Progress(std::string what, bool quiet, double earlier)
    : what_(std::move(what)), quiet_(quiet), earlier_(earlier), terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::clear() {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
    drawn_ = false;
}

void Progress::show(double done, double total, const std::optional<Pattern>& at) {
    if (quiet_ || total <= 0) return;
    const auto now = Clock::now();
    const std::chrono::duration<double> since = now - last_;
    if (since.count() < (terminal_ ? 0.1 : 10.0)) return;
    last_ = now;
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    const double share = done / total;
    std::string figures = fmt::format("{:.0f} %", std::floor(100 * share));
    if (done > earlier_) figures += ", " + time_text(elapsed * (total - done) / (done - earlier_)) + " left";
    if (at) figures += fmt::format(", at ({}, {})", at->free_steps, at->contact_steps);
    if (terminal_) {
        // A line that wraps would be drawn below itself again and again.
        winsize size{};
        const std::size_t room =
            ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col - 1U : 79U;
        constexpr std::size_t width = 24;
        const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * width);
        const std::string bar = fmt::format(" [{}{}]", std::string(full, '#'), std::string(width - full, '.'));
        std::string line = what_ + bar + " " + figures;
        if (line.size() > room) line = what_ + " " + figures;
        line.resize(std::min(line.size(), room));
        line.insert(0, "\r\x1b[K");
        std::fputs(line.c_str(), stderr);
        drawn_ = true;
    } else {
        std::fputs(fmt::format("{}: {}\n", what_, figures).c_str(), stderr);
    }
    std::fflush(stderr);
}

}  // namespace nsma::app
