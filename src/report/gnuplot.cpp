#include "gnuplot.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "charts.hpp"
#include "one_line.hpp"

extern "C" char** environ;

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr const char* script_head = R"(# Drawn by nsma; draw again with: gnuplot {0}.gp
set encoding utf8
do for [format in "svg png"] {{
if (format eq "svg") {{
    set terminal svg size 1000,{1} font 'sans-serif,14' linewidth 1 enhanced background rgb 'white'
}} else {{
    set terminal pngcairo size 1600,{2} font 'sans-serif,14' fontscale 1.5 linewidth 1.6 pointscale 1.6 enhanced
}}
set output '{0}.'.format
reset
mark = format eq "svg" ? 0.65 : 1.0
)";

void write_file(const fs::path& path, const std::string& text) {
    errno = 0;
    std::FILE* file = std::fopen(path.c_str(), "wb");
    bool written = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (file != nullptr) written = std::fclose(file) == 0 && written;
    if (!written) {
        throw InputError(one_line(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))));
    }
}

/// Runs `gnuplot NAME.gp` in the folder; returns its exit status and what it said.
std::pair<int, std::string> run_gnuplot(const std::string& script, const fs::path& folder) {
    std::array<int, 2> channel{};
    if (pipe2(channel.data(), O_CLOEXEC) != 0) throw InputError("gnuplot: cannot be started: no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, channel[1], 1);
    posix_spawn_file_actions_adddup2(&actions, channel[1], 2);
    std::string program = "gnuplot";
    std::string defaults = "--default-settings";
    std::string file = script;
    std::array<char*, 4> arguments{program.data(), defaults.data(), file.data(), nullptr};
    pid_t child = 0;
    const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(channel[1]);
    if (error != 0) {
        close(channel[0]);
        throw InputError(
            fmt::format("gnuplot: cannot be started: {}; install gnuplot-nox to draw charts", std::strerror(error)));
    }
    std::string said;
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t got = read(channel[0], buffer.data(), buffer.size());
        if (got > 0) said.append(buffer.data(), static_cast<std::size_t>(got));
        if (got == 0 || (got < 0 && errno != EINTR)) break;
    }
    close(channel[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return {status, said};
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
    std::string quoted = "'";
    for (const char letter : one_line(std::string(text))) {
        quoted += letter;
        if (letter == '\'') quoted += letter;
    }
    return quoted + "'";
}

ScaledUnit scaled_unit(double largest, const std::string& unit) {
    static constexpr std::array<const char*, 9> prefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
    if (!std::isfinite(largest) || !(largest > 0.0)) return {1.0, unit};
    const int step = std::clamp(static_cast<int>(std::floor(std::log10(largest) / 3.0 + 1e-9)), -4, 4);
    // Between 0.1 and 1 the plain unit reads better than thousandths of it.
    const int kept = step == -1 && largest >= 0.1 ? 0 : step;
    return {std::pow(10.0, -3 * kept), prefixes.at(static_cast<std::size_t>(kept + 4)) + unit};
}

void draw_chart(const Chart& chart, const fs::path& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) throw InputError(one_line(fmt::format("{}: cannot be made: {}", folder.string(), code.message())));
    const std::string script = chart.name + ".gp";
    write_file(folder / (chart.name + ".dat"), chart.data);
    write_file(folder / script, fmt::format(fmt::runtime(script_head), chart.name, chart.height, chart.height * 8 / 5) +
                                    chart.commands + "unset output\n}\n");
    for (const char* format : {".svg", ".png"}) fs::remove(folder / (chart.name + format), code);

    const auto [status, said] = run_gnuplot(script, folder);
    bool drawn = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    for (const char* format : {".svg", ".png"}) {
        const auto size = fs::file_size(folder / (chart.name + format), code);
        drawn = drawn && !code && size > 0;
    }
    if (drawn) return;
    std::string tail = one_line(said);
    if (tail.size() > 300) tail = "..." + tail.substr(tail.size() - 300);
    throw InputError(one_line(
        fmt::format("{}: gnuplot failed: {}", (folder / script).string(), tail.empty() ? "no message" : tail)));
}

}  // namespace nsma
