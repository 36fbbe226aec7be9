#include "nsma/orbit/kernel.hpp"

#include "index.hpp"

namespace nsma {

Kernel exact_kernel(const Pattern& pattern) {
    validate(pattern);
    Kernel kernel;
    kernel.pattern = pattern;
    kernel.classes = pattern.class_count();
    const int period = pattern.period_steps();
    const int shift = (2 * pattern.cells) % period;
    kernel.sign.assign(index(period), 0);
    kernel.amplitude_of.assign(index(kernel.classes), -1);

    const auto next = [period, shift](int n) { return n < period - shift ? n + shift : n - (period - shift); };
    for (int first = 0; first < kernel.classes; ++first) {
        // b_{n+2N} = -b_n after a free step, +b_n after a contact step.
        std::int8_t sign = 1;
        int n = first;
        do {
            kernel.sign[index(n)] = sign;
            if (n < pattern.free_steps) {
                sign = static_cast<std::int8_t>(-sign);
            }
            n = next(n);
        } while (n != first);
        if (sign == 1) {
            kernel.amplitude_of[index(first)] = kernel.dimension();
            kernel.class_of.push_back(first);
        } else {  // b_first = -b_first: the class is dead
            do {
                kernel.sign[index(n)] = 0;
                n = next(n);
            } while (n != first);
        }
    }
    return kernel;
}

Eigen::VectorXd Kernel::waves(const Eigen::VectorXd& amplitudes) const {
    return Eigen::VectorXd::NullaryExpr(pattern.period_steps(),
                                        [&](Eigen::Index n) { return wave(amplitudes, static_cast<int>(n)); });
}

Eigen::MatrixXd wave_basis(const Kernel& kernel) {
    const int window = 2 * kernel.pattern.cells;
    const int period = kernel.pattern.period_steps();
    Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(window, kernel.dimension());
    for (int k = 0; k < window; ++k) {
        const int column = kernel.column(k % period);
        if (column >= 0) {
            basis(k, column) = kernel.sign[index(k % period)];
        }
    }
    return basis;
}

}  // namespace nsma
