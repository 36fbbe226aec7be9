#include <nsma/orbit/pattern.hpp>
#include <nsma/wave/bar.hpp>

int main() {
    const nsma::Bar bar{.length = 2.0};
    const nsma::Pattern pattern{.cells = 6, .free_steps = 16, .contact_steps = 4};
    const bool right = bar.travel_time() == 2.0 && nsma::kernel_dimension(pattern) == 4;
    return right ? 0 : 1;
}
