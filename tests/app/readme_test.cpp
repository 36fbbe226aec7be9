// What README.md shows of a terminal is what a terminal shows.
#include "program.hpp"

namespace {

TEST(Readme, ShowsWhatTheCommandsPrint) {
    const process::Folder folder;
    const std::filesystem::path out = folder.path() / "out";
    std::string command, shown;
    int commands = 0;
    const auto compare = [&] {
        if (command.empty()) return;
        SCOPED_TRACE(command);
        // "nsma" is the program that was built, and the commands are given in the project's folder.
        const std::string line = "cd '" NSMA_SOURCE "' && nsma() { '" NSMA_PROGRAM "' \"$@\"; } && " + command;
        EXPECT_EQ(process::finish(process::start({"sh", "-c", line}, out, folder.path() / "err")), 0);
        EXPECT_EQ(process::contents(out), shown);
        ++commands;
    };
    bool inside = false;
    for (const std::string& line : process::lines_of(process::contents(NSMA_SOURCE "/README.md"))) {
        const bool begins = inside && line.starts_with("$ ");
        const bool fence = line.starts_with("```");
        if (begins || fence) {
            compare();
            command = begins ? line.substr(2) : std::string();
            shown.clear();
        } else if (!command.empty()) {
            shown += line + "\n";
        }
        if (fence) inside = !inside;
    }
    EXPECT_GE(commands, 2);
}

TEST(Readme, IsShort) { EXPECT_LE(process::lines_of(process::contents(NSMA_SOURCE "/README.md")).size(), 150U); }

}  // namespace
