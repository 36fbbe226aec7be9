#include <atomic>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <new>
#include <string_view>

#include <unistd.h>

#include "command.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "numerics/freed_memory.hpp"
#include "nsma/report/input_error.hpp"

namespace {

// Of the first signal; the second ends at once, but not its echo: timeout and terminals send each twice.
std::atomic<std::int64_t> first_signal_ms{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

extern "C" void on_signal(int signal) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const std::int64_t ms = std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
    constexpr std::int64_t echo_ms = 300;
    if (nsma::request_stop(signal) == 0) {
        first_signal_ms = ms;
    } else if (ms - first_signal_ms > echo_ms) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

// An exception that no function may let through, as where a library promised to throw none and found no memory.
[[noreturn]] void on_terminate() {
    constexpr std::string_view line =
        "nsma: ended by an error inside a library, not enough memory perhaps; what was done is kept\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, line.data(), line.size());
    _exit(nsma::app::exit_solver);
}

int run(int count, char** words) {
    using namespace nsma::app;
    try {
        const auto command = read_command_line(count, words);
        return command ? command->run(command->arguments) : exit_done;
    } catch (const nsma::Interrupted&) {
        return exit_interrupted;
    } catch (const nsma::InputError& error) {
        say("{}", error.what());
        return exit_input;
    } catch (const std::bad_alloc&) {
        say("not enough memory for this; what was done until here is kept");
        return exit_solver;
    } catch (const std::system_error& error) {
        if (std::ferror(stdout) != 0) return output_failed(error.code());
        say("internal error: {}", error.what());
        return exit_solver;
    } catch (const std::exception& error) {
        say("internal error: {}", error.what());
        return exit_solver;
    }
}

}  // namespace

int main(int count, char** words) {
    std::set_terminate(on_terminate);
    nsma::app::hold_standard_streams();
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    std::signal(SIGUSR1, on_signal);  // mpirun hands it on to its ranks; a SIGTERM it follows with SIGKILL
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then an error like a full disk
    nsma::keep_freed_memory();
    const int code = nsma::app::finish_output(run(count, words));
    const bool terminated = code == nsma::app::exit_interrupted && nsma::stop_signal() == SIGTERM;
    return terminated ? nsma::app::exit_terminated : code;
}
