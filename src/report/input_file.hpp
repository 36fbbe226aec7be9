#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace nsma {

/// A file, pipe or device read from its beginning. What cannot be read to its end throws InputError (one line with the
/// file and where it stopped), a wait for a pipe that is asked to end throws Interrupted.
class InputFile {
public:
    /// `what` the file should be, as messages call it: "a scene file".
    InputFile(std::filesystem::path file, const std::string& what);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    /// All of it, at most `most` bytes.
    [[nodiscard]] std::string text(std::size_t most);
    /// The next line without its end, at most `most` bytes long; false: there is none.
    [[nodiscard]] bool line(std::string& line, std::size_t most);
    [[nodiscard]] long line_number() const { return lines_; }  ///< of the line read last, from 1

private:
    [[nodiscard]] bool fill();
    void append(std::string& text, std::size_t count, std::size_t most);

    std::filesystem::path path_;
    int file_ = -1;
    bool waits_ = false;  // for a writer, which may never write
    std::vector<char> buffer_;
    std::size_t at_ = 0, end_ = 0;  // in the buffer
    long lines_ = 0;
    std::size_t bytes_ = 0;  // handed out
};

}  // namespace nsma
