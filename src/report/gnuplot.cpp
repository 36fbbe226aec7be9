#include <cstdio>
#include <fstream>

#include <fmt/format.h>
#include <sys/wait.h>

#include "chart.hpp"
#include "results_folder.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

std::string shell_quoted(const fs::path& path) {
    std::string quoted = "'";
    for (const char letter : path.string()) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
    return quoted + "'";
}

/// Whether a picture has the end that its format asks for: gnuplot does not say when the disk is full.
bool whole(const fs::path& picture) {
    std::ifstream file(picture, std::ios::binary);
    constexpr int tail = 16;
    file.seekg(-tail, std::ios::end);
    std::string end(tail, '\0');
    return file.read(end.data(), tail) &&
           end.find(picture.extension() == ".svg" ? "</svg>" : "IEND") != std::string::npos;
}

/// Runs `gnuplot NAME.gp` in the folder; returns whether it succeeded and what it said.
std::pair<bool, std::string> run_gnuplot(const std::string& script, const fs::path& folder) {
    const std::string command = fmt::format("cd {} && exec gnuplot --default-settings {} 2>&1 </dev/null",
                                            shell_quoted(fs::absolute(folder)), script);
    std::FILE* output = popen(command.c_str(), "re");
    if (output == nullptr) throw InputError("gnuplot: cannot be started: no pipe");
    std::string said;
    for (int letter = 0; (letter = std::fgetc(output)) != EOF;) said += static_cast<char>(letter);
    const int status = pclose(output);
    constexpr int no_such_program = 127;
    if (WIFEXITED(status) && WEXITSTATUS(status) == no_such_program) {
        throw NoGnuplot("gnuplot: cannot be started: No such file or directory; install gnuplot-nox to draw charts");
    }
    return {WIFEXITED(status) && WEXITSTATUS(status) == 0, said};
}

}  // namespace

void draw_chart(const Chart& chart, const fs::path& folder) {
    make_folder(folder);
    std::error_code code;
    const std::string script = chart.name + ".gp";
    write_whole(folder / (chart.name + ".dat"), chart.data);
    write_whole(folder / script, gnuplot_script(chart));
    for (const char* format : {".svg", ".png"}) fs::remove(folder / (chart.name + format), code);

    auto [drawn, said] = run_gnuplot(script, folder);
    for (const char* format : {".svg", ".png"}) {
        drawn = drawn && whole(folder / (chart.name + format));
    }
    if (drawn) return;
    if (said.size() > 300) said = "..." + said.substr(said.size() - 300);
    fail(folder / script, "gnuplot failed: " + (said.empty() ? "no message" : said));
}

std::vector<fs::path> draw_charts(const std::vector<Chart>& charts, const fs::path& folder) {
    std::vector<fs::path> pictures;
    for (const Chart& chart : charts) {
        draw_chart(chart, folder);
        for (const char* format : {".svg", ".png"}) pictures.push_back(folder / (chart.name + format));
    }
    return pictures;
}

}  // namespace nsma
