#include "guarded_solver.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <limits>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "program_methods.hpp"

namespace nsma {
namespace {

constexpr std::size_t status_length = 48;

// What the child writes: this, then the point.
struct Answer {
    int iterations = 0;
    double seconds = 0;
    char status[status_length] = {};
};

bool write_all(int channel, const void* data, std::size_t size) {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t done = write(channel, bytes, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        bytes += done;
        size -= static_cast<std::size_t>(done);
    }
    return true;
}

// Reads until the end of the channel or the deadline [ms from now].
std::vector<char> read_all(int channel, int milliseconds) {
    std::vector<char> bytes;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        pollfd ready{channel, POLLIN, 0};
        const int got = poll(&ready, 1, std::max(0, static_cast<int>(left.count())));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return bytes;
        char buffer[4096];
        const ssize_t count = read(channel, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return bytes;
        bytes.insert(bytes.end(), buffer, buffer + count);
    }
}

}  // namespace

SolverOutcome solve_guarded(NloptMethod method, const Program& program, const Eigen::VectorXd& start,
                            const SolverOptions& options, double limit) {
    SolverOutcome outcome;
    outcome.x = Eigen::VectorXd::Constant(start.size(), std::numeric_limits<double>::quiet_NaN());
    outcome.status = "KILLED";
    outcome.seconds = limit;
    int channel[2] = {};
    if (pipe2(channel, O_CLOEXEC) != 0) {
        outcome.status = "NO_PIPE";
        return outcome;
    }
    const pid_t child = fork();
    if (child == 0) {
        Answer answer;
        SolverOutcome solved;
        const double begin = cpu_seconds();
        try {
            solved = solve_with_nlopt(method, program, start, options);
        } catch (...) {
            _exit(1);
        }
        answer.seconds = cpu_seconds() - begin;
        answer.iterations = solved.iterations;
        solved.status.copy(answer.status, status_length - 1);
        const auto size = static_cast<std::size_t>(solved.x.size()) * sizeof(double);
        const bool sent = write_all(channel[1], &answer, sizeof answer) && write_all(channel[1], solved.x.data(), size);
        _exit(sent ? 0 : 1);
    }
    close(channel[1]);
    if (child < 0) {
        close(channel[0]);
        outcome.status = "NO_CHILD";
        return outcome;
    }
    const std::vector<char> bytes = read_all(channel[0], static_cast<int>(limit * 1000));
    close(channel[0]);
    kill(child, SIGKILL);  // still our child: not waited for yet
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    const auto point = static_cast<std::size_t>(start.size()) * sizeof(double);
    if (bytes.size() != sizeof(Answer) + point) return outcome;
    Answer answer;
    std::memcpy(&answer, bytes.data(), sizeof answer);
    std::memcpy(outcome.x.data(), bytes.data() + sizeof answer, point);
    outcome.iterations = answer.iterations;
    outcome.seconds = answer.seconds;
    outcome.status = answer.status;
    return outcome;
}

}  // namespace nsma
