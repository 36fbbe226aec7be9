#include "standard_streams.hpp"

#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

#include "command.hpp"

namespace nsma::app {

void hold_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(stream, F_GETFD) >= 0) continue;
        // The lowest free number is this stream's. Opened the wrong way round, its use is still an error.
        (void)open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

void say_line(std::string_view text) {
    std::fflush(stdout);  // what was said before it stands before it
    const char* const cleared = isatty(STDERR_FILENO) != 0 ? "\r\x1b[K" : "";  // of a bar of progress
    std::fprintf(stderr, "%snsma: %.*s\n", cleared, static_cast<int>(text.size()), text.data());
}

int output_failed(const std::error_code& error) {
    constexpr int ended_by_sigpipe = 128 + 13;
    if (error == std::errc::broken_pipe) return ended_by_sigpipe;
    say("standard output: cannot be written: {}", error.message());
    return exit_input;
}

int finish_output(int code) {
    const bool failed = std::ferror(stdout) != 0;
    if (std::fclose(stdout) == 0 && !failed) return code;
    const std::error_code error(failed ? EIO : errno, std::generic_category());
    return code == exit_input || code > 128 ? code : output_failed(error);
}

}  // namespace nsma::app
