// nsma_measure COMMAND...: runs it and prints wall time [s], CPU time [s] and the peak memory of its largest process
// [MB].

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

int main(int count, char** words) {
    if (count < 2) {
        std::fprintf(stderr, "usage: nsma_measure COMMAND...\n");
        return 2;
    }
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        execvp(words[1], words + 1);
        _exit(127);
    }
    int status = 0;
    rusage usage{};
    const bool ended = child > 0 && wait4(child, &status, 0, &usage) == child && WIFEXITED(status);
    // Of nsma 2 is bad usage; other codes are results.
    if (!ended || WEXITSTATUS(status) == 127 || WEXITSTATUS(status) == 2) {
        std::fprintf(stderr, "%s: cannot be run, or not so\n", words[1]);
        return 1;
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    std::printf("%.2f,%.2f,%.1f\n", wall.count(), seconds(usage.ru_utime) + seconds(usage.ru_stime),
                static_cast<double>(usage.ru_maxrss) / 1024);
    return 0;
}
