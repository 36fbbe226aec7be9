#include <cmath>

#include "accuracy_parts.hpp"
#include "kernel_methods.hpp"

namespace nsma {
namespace {

constexpr KernelMethod kernel_methods[] = {KernelMethod::exact_cycles, KernelMethod::dense_svd,
                                           KernelMethod::rank_revealing_qr, KernelMethod::matrix_powers};
constexpr double slow_kernel = 0.5;  // seconds; one run of such work is enough

void study_tolerances(AccuracyRun& run, const Pattern& pattern) {
    Eigen::VectorXd tolerances(17);
    for (Eigen::Index i = 0; i < tolerances.size(); ++i) tolerances[i] = std::pow(10.0, static_cast<double>(i) - 17.0);
    // The neighbour shares few divisors with the window: long cycles, whose singular values come near zero.
    const Pattern neighbour{pattern.cells, pattern.free_steps - 1, pattern.contact_steps};
    for (const KernelMethod method : {KernelMethod::dense_svd, KernelMethod::rank_revealing_qr}) {
        for (const Pattern& one : {pattern, neighbour}) {
            const Eigen::VectorXi found = dimensions_found(method, run.scene.bar, one, tolerances);
            for (Eigen::Index i = 0; i < found.size(); ++i) {
                run.add(
                    ToleranceRecord{one, std::string(name(method)), tolerances[i], found[i], kernel_dimension(one)});
            }
        }
    }
}

}  // namespace

void study_kernels(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    for (const int size : run.sizes.kernels) {
        const Pattern pattern = accuracy_pattern(size, bar.gap_sign());
        const Eigen::MatrixXd exact = kernel_space(KernelMethod::exact_cycles, bar, pattern);
        for (const KernelMethod method : kernel_methods) {
            if (!run.go_on()) return;
            Eigen::MatrixXd basis;
            const auto find = [&] { basis = kernel_space(method, bar, pattern); };
            const Spread seconds = repeated(
                run.sizes.repeats, [&] { return cpu_seconds_of(find); }, slow_kernel);
            run.add(KernelRecord{pattern, std::string(name(method)), seconds, static_cast<int>(basis.cols()),
                                 kernel_dimension(pattern), space_distance(basis, exact)});
        }
        if (!run.go_on()) return;
        study_tolerances(run, pattern);
    }
}

}  // namespace nsma
