#pragma once

#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace nsma::app {

/// To be called before any file is opened: a standard stream that the caller closed would else be the next file that is
/// opened, and messages would land in results. What is written to it fails as it should.
void hold_standard_streams();

/// A line on stderr. Where it cannot be written nothing else is lost for it.
void say_line(std::string_view text);
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
    say_line(fmt::format(format, std::forward<Values>(values)...));
}

/// The exit code where standard output cannot be written, with its message. A reader that has enough, as head, is no
/// error of ours: the code is then that of a program ended by SIGPIPE, and nothing is said.
[[nodiscard]] int output_failed(const std::error_code& error);

/// Writes out what is buffered of standard output and closes it; the exit code that follows from `code`.
[[nodiscard]] int finish_output(int code);

}  // namespace nsma::app
