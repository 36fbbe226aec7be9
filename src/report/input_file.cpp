#include "input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "results_folder.hpp"
#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

constexpr std::size_t piece = 1U << 16U;
constexpr int look_again = 100;  // ms, for a signal that came

}  // namespace

InputFile::InputFile(std::filesystem::path file, const std::string& what) : path_(std::move(file)), buffer_(piece) {
    // Without O_NONBLOCK the opening of a pipe waits for its writer, and no signal would end that.
    file_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file_ < 0) fail(path_, fmt::format("expected {}, got an error: {}", what, std::strerror(errno)));
    struct stat status {};
    if (fstat(file_, &status) == 0 && S_ISDIR(status.st_mode)) {
        close(file_);
        fail(path_, fmt::format("expected {}, got a directory", what));
    }
    waits_ = !S_ISREG(status.st_mode);
}

InputFile::~InputFile() { close(file_); }

// The next bytes into the empty buffer; false at the end of the file.
bool InputFile::fill() {
    for (;;) {
        if (waits_) stop_point();
        pollfd ready{file_, POLLIN, 0};
        if (poll(&ready, 1, look_again) <= 0) continue;
        const ssize_t got = read(file_, buffer_.data(), buffer_.size());
        if (got >= 0) {
            at_ = 0;
            end_ = static_cast<std::size_t>(got);
            return got > 0;
        }
        if (errno == EINTR || errno == EAGAIN) continue;
        fail(path_, fmt::format("line {}: cannot be read after byte {}: {}", lines_ + 1, bytes_, std::strerror(errno)));
    }
}

void InputFile::append(std::string& text, std::size_t count, std::size_t most) {
    if (text.size() + count > most) {
        fail(path_, fmt::format("line {}: expected at most {} bytes, got more after byte {}", lines_ + 1, most,
                                bytes_ - text.size()));
    }
    text.append(buffer_.data() + at_, count);
    at_ += count;
    bytes_ += count;
}

std::string InputFile::text(std::size_t most) {
    std::string text;
    do append(text, end_ - at_, most);
    while (fill());
    return text;
}

bool InputFile::line(std::string& line, std::size_t most) {
    line.clear();
    for (;;) {
        const char* const begin = buffer_.data() + at_;
        const char* const found = std::find(begin, begin + (end_ - at_), '\n');
        append(line, static_cast<std::size_t>(found - begin), most);
        if (at_ < end_) {
            ++at_;  // the end of the line
            ++bytes_;
            break;
        }
        if (fill()) continue;
        if (line.empty()) return false;
        break;
    }
    ++lines_;
    return true;
}

}  // namespace nsma
