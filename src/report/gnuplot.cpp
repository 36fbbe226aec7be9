#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

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
    const std::string format = picture.extension();
    const char* const mark = format == ".svg" ? "</svg>" : format == ".png" ? "IEND" : "%%EOF";
    return file.read(end.data(), tail) && end.find(mark) != std::string::npos;
}

/// Throws NoGnuplot where the shell would find none: before anything that is there is touched.
void expect_gnuplot() {
    const char* const folders = std::getenv("PATH");
    std::istringstream path(folders != nullptr ? folders : "");
    for (std::string folder; std::getline(path, folder, ':');) {
        if (access((fs::path(folder) / "gnuplot").c_str(), X_OK) == 0) return;
    }
    throw NoGnuplot("gnuplot: cannot be started: No such file or directory; install gnuplot-nox to draw charts");
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
    return {WIFEXITED(status) && WEXITSTATUS(status) == 0, said};
}

// Has gnuplot run NAME.gp.
std::vector<fs::path> draw_chart(const Chart& chart, const fs::path& folder, const Drawing& drawing) {
    std::vector<fs::path> pictures;
    for (const std::string& format : drawing.formats) pictures.push_back(folder / (chart.name + '.' + format));
    std::error_code code;
    for (const fs::path& picture : pictures) fs::remove(picture, code);
    const std::string script = chart.name + ".gp";
    auto [drawn, said] = run_gnuplot(script, folder);
    if (drawn && std::all_of(pictures.begin(), pictures.end(), whole)) return pictures;
    if (said.size() > 300) said = "..." + said.substr(said.size() - 300);
    fail(folder / script, "gnuplot failed: " + (said.empty() ? "no message" : said));
}

}  // namespace

std::vector<fs::path> draw_charts(const std::vector<Chart>& charts, const fs::path& folder, const Drawing& drawing) {
    expect_gnuplot();
    make_folder(folder);
    for (const Chart& chart : charts) {
        write_whole(folder / (chart.name + ".dat"), chart.data);
        write_whole(folder / (chart.name + ".gp"), gnuplot_script(chart, drawing));
    }
    std::vector<fs::path> pictures;
    for (const Chart& chart : charts) {
        for (fs::path& picture : draw_chart(chart, folder, drawing)) pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace nsma
