#pragma once

#include <chrono>
#include <string>

namespace nsma::app {

/// Progress on stderr: a bar with rate and time left on a terminal, a plain line every ten
/// seconds elsewhere, nothing when quiet.
class Progress {
public:
    Progress(std::string what, bool quiet);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(long done, long total);
    void clear();  ///< takes the bar from the terminal

private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    bool quiet_;
    bool terminal_;
    bool drawn_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

}  // namespace nsma::app
