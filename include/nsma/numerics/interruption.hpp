#pragma once

#include <exception>

namespace nsma {

/// Ends a computation that was asked to stop; no error.
class Interrupted : public std::exception {
public:
    /// The word "interrupted".
    [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

/// Asks every computation of this process to end at its next stop_point(). For signal handlers: `signal` is kept until
/// the next request; returns the one before, 0 where there was none.
int request_stop(int signal) noexcept;

/// The signal of request_stop(), or 0.
[[nodiscard]] int stop_signal() noexcept;
/// Whether a stop was requested.
[[nodiscard]] inline bool stop_requested() noexcept { return stop_signal() != 0; }

/// Throws Interrupted once a stop is requested. Stands in every loop that may take more than a second.
void stop_point();

}  // namespace nsma
