// Any words, one a line: refused in one line, a page of help, or a command with its arguments in range.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "fuzz.hpp"

#include "nsma/wave/mesh.hpp"
#include "nsma/report/input_error.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    return std::freopen("/dev/null", "w", stdout) == nullptr ? 1 : 0;  // pages of help
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::string> words{"nsma"};
    for (std::size_t i = 0; i < size; ++i) {
        if (i == 0 || data[i] == '\n') words.emplace_back();
        if (data[i] != '\n' && data[i] != '\0') words.back() += static_cast<char>(data[i]);
    }
    std::vector<const char*> pointers;
    for (const std::string& word : words) pointers.push_back(word.c_str());
    try {
        const auto command = nsma::app::read_command_line(static_cast<int>(pointers.size()), pointers.data());
        if (!command) return 0;
        const nsma::app::Arguments& said = command->arguments;
        fuzz::expect(command->run != nullptr, "something to run");
        fuzz::expect(!said.cells || (*said.cells >= 1 && *said.cells <= nsma::max_cells), "cells");
        fuzz::expect(!said.gap || std::isfinite(*said.gap), "gap");
        fuzz::expect(!said.energy || (*said.energy > 0 && std::isfinite(*said.energy)), "energy");
        fuzz::expect((said.free_steps > 0) == (said.contact_steps > 0), "a pattern has both");
    } catch (const nsma::InputError& error) {
        fuzz::expect_one_line(error.what());
    }
    return 0;
}
