#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../support/process.hpp"

/// The program as a user runs it, in a folder with a scene.
class Program : public testing::Test {
protected:
    using Words = std::vector<std::string>;
    struct Result {
        int exit_code = -1;  ///< -signal when a signal ended it
        std::string out;
        std::string err;
    };

    static std::string scene_text(const std::string& gap = "1.0", const std::string& cells = "6",
                                  const std::string& patterns = "list = [[16, 4], [23, 1]]",
                                  const std::string& levels = "[1.6, 12.0]",
                                  const std::string& objective = "least-shock") {
        return "title = \"Test\"\n[bar]\nlength = 1.0\nyoung_modulus = 1.0\ndensity = 1.0\narea = 1.0\ngap = " + gap +
               "\n[mesh]\ncells = " + cells + "\n[patterns]\n" + patterns + "\n[levels]\nlist = " + levels +
               "\n[program]\nobjective = \"" + objective + "\"\n";
    }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

    static Words with(Words words, const Words& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    [[nodiscard]] pid_t start(const Words& words) const {
        return process::start(with({NSMA_PROGRAM}, words), folder_ / ".out", folder_ / ".err");
    }
    [[nodiscard]] Result finish(pid_t child) const {
        const int exit_code = process::finish(child);
        return {exit_code, process::contents(folder_ / ".out"), process::contents(folder_ / ".err")};
    }
    [[nodiscard]] Result run(const Words& words) const { return finish(start(words)); }

    [[nodiscard]] Words files() const {
        Words names;
        for (const auto& entry : process::fs::recursive_directory_iterator(folder_)) {
            const std::string name = process::fs::relative(entry.path(), folder_).string();
            if (name[0] != '.') names.push_back(name);
        }
        std::sort(names.begin(), names.end());
        return names;
    }

    /// Exit 2, one line on stderr, nothing on stdout, no file made.
    void expect_refused(const Words& words, const std::string& named = {}) const {
        std::string command;
        for (const auto& word : words) command += word + " ";
        SCOPED_TRACE(command);
        const auto before = files();
        const Result result = run(words);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_EQ(result.err.find("internal"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(named), std::string::npos) << result.err;
        EXPECT_EQ(files(), before);
    }

private:
    process::Folder own_;

protected:
    const process::fs::path& folder_ = own_.path();
    const std::string scene_ = write("scene.toml", scene_text());
};
