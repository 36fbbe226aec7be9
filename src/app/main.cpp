#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>

#include "command.hpp"
#include "crew.hpp"

#include "numerics/freed_memory.hpp"
#include "nsma/report/input_error.hpp"

namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// The first Ctrl-C asks for an orderly end, the second ends at once.
extern "C" void on_interrupt(int signal) {
    if (stop_requested.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

int main(int count, char** words) {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    std::signal(SIGUSR1, on_interrupt);  // mpirun hands it on to its ranks; a SIGTERM it follows with SIGKILL
    std::signal(SIGPIPE, SIG_IGN);
    nsma::keep_freed_memory();
    std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then an error like a full disk
    try {
        const auto command = nsma::app::read_command_line(count, words);
        const int code = command ? command->run(command->arguments, stop_requested) : nsma::app::exit_done;
        // After Ctrl-C the reader of a pipe may be gone as well.
        if (code != nsma::app::exit_interrupted && (std::fflush(stdout) != 0 || std::ferror(stdout) != 0))
            throw nsma::InputError("stdout: expected room to write, got an error");
        return code;
    } catch (const nsma::InputError& error) {
        if (!nsma::app::silent_rank()) std::fprintf(stderr, "nsma: %s\n", error.what());
        return nsma::app::exit_input;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "nsma: internal error: %s\n", error.what());
        return nsma::app::exit_solver;
    }
}
