#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "nsma/orbit/pattern.hpp"

namespace nsma::app {

/// Progress on stderr: a bar with share and time left on a terminal, a plain line every ten seconds elsewhere, nothing
/// when quiet. Work is counted in any unit that takes about the same time throughout.
class Progress {
public:
    /// `earlier`: work that an earlier run did, which tells nothing of how fast this one is.
    Progress(std::string what, bool quiet, double earlier = 0);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `at`: the pattern at hand.
    void show(double done, double total, const std::optional<Pattern>& at = std::nullopt);
    void clear();  ///< takes the bar from the terminal

private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    bool quiet_;
    double earlier_;
    bool terminal_;
    bool drawn_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

}  // namespace nsma::app
