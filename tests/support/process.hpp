#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

/// Programs run as processes, and a folder for what they write.
namespace process {

namespace fs = std::filesystem;

inline std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// A new folder, removed at the end with all that is in it.
class Folder {
public:
    Folder() {
        std::string name = (fs::temp_directory_path() / "nsma-test-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
        path_ = name;
    }
    ~Folder() {
        std::error_code code;
        fs::remove_all(path_, code);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// What the machine may refuse the started program.
struct Limits {
    rlim_t file_size = RLIM_INFINITY;  ///< bytes; a write beyond fails, as on a full disk
    bool no_rights = false;            ///< not root, for whom every folder is writable
};

/// Starts a program in a process group of its own, so that what it starts can be ended with it. Exit codes 126 and 127:
/// there is no other user, or no such program.
inline pid_t start(std::vector<std::string> words, const fs::path& out, const fs::path& err,
                   const Limits& limits = {}) {
    constexpr uid_t nobody = 65534;
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    setpgid(0, 0);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    const int file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(out == err ? file : open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    if (limits.file_size != RLIM_INFINITY) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{limits.file_size, limits.file_size};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (limits.no_rights && getuid() == 0 && setuid(nobody) != 0) _exit(126);
    execvp(pointers[0], pointers.data());
    _exit(127);
}

/// Waits: the exit code, or -signal when a signal ended it.
inline int finish(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// Whether it has ended; finish() then returns at once.
inline bool ended(pid_t child) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
}

/// Looks every few milliseconds until `done`, at most `seconds`.
template <class Done>
bool wait_for(Done done, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!done()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

}  // namespace process
