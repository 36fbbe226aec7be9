#include "guarded_solver.hpp"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <limits>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cpu_time.hpp"

namespace nsma {
namespace {

// What the child leaves in the memory it shares with us, followed by the point.
struct Answer {
    bool complete;
    int iterations;
    double seconds;
    char status[48];
};

// The child's whole life.
[[noreturn]] void answer_and_exit(Answer* answer, NloptMethod method, const Program& program,
                                  const Eigen::VectorXd& start, const SolverOptions& options, double limit) {
    signal(SIGALRM, SIG_DFL);
    alarm(static_cast<unsigned>(std::ceil(limit)));  // ends the process wherever it is
    try {
        SolverOutcome solved;
        answer->seconds = cpu_seconds_of([&] { solved = solve_with_nlopt(method, program, start, options); });
        answer->iterations = solved.iterations;
        solved.status.copy(answer->status, sizeof answer->status - 1);
        Eigen::Map<Eigen::VectorXd>(reinterpret_cast<double*>(answer + 1), start.size()) = solved.x;
        answer->complete = true;
    } catch (...) {
    }
    _exit(0);
}

}  // namespace

SolverOutcome solve_guarded(NloptMethod method, const Program& program, const Eigen::VectorXd& start,
                            const SolverOptions& options, double limit) {
    SolverOutcome outcome{Eigen::VectorXd::Constant(start.size(), std::numeric_limits<double>::quiet_NaN()), "KILLED",
                          0, limit};
    const std::size_t size = sizeof(Answer) + static_cast<std::size_t>(start.size()) * sizeof(double);
    void* shared = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);  // zeros
    if (shared == MAP_FAILED) return outcome;
    const auto* answer = static_cast<const Answer*>(shared);
    const pid_t child = fork();
    if (child == 0) answer_and_exit(static_cast<Answer*>(shared), method, program, start, options, limit);
    while (child > 0 && waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    if (answer->complete) {
        outcome.x = Eigen::Map<const Eigen::VectorXd>(reinterpret_cast<const double*>(answer + 1), start.size());
        outcome.status = answer->status;
        outcome.iterations = answer->iterations;
        outcome.seconds = answer->seconds;
    }
    munmap(shared, size);
    return outcome;
}

}  // namespace nsma
