#include "nsma/numerics/interruption.hpp"

#include <atomic>

namespace nsma {
namespace {

std::atomic<int> requested{0};
static_assert(std::atomic<int>::is_always_lock_free);  // else no signal handler may touch it

}  // namespace

int request_stop(int signal) noexcept { return requested.exchange(signal); }

int stop_signal() noexcept { return requested.load(std::memory_order_relaxed); }

void stop_point() {
    if (stop_requested()) throw Interrupted();
}

}  // namespace nsma
