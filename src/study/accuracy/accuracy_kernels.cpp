#include <cmath>

#include "accuracy_parts.hpp"
#include "kernel_methods.hpp"
#include "program_methods.hpp"

namespace nsma {
namespace {

constexpr KernelMethod methods[] = {KernelMethod::exact_cycles, KernelMethod::dense_svd,
                                    KernelMethod::rank_revealing_qr, KernelMethod::matrix_powers};
constexpr double slow_run = 0.5;  // seconds; one run of such work is enough

}  // namespace

void study_kernels(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    for (const int size : run.sizes.kernels) {
        const Pattern pattern = accuracy_pattern(size, bar.gap_sign());
        const Eigen::MatrixXd exact = kernel_space(KernelMethod::exact_cycles, bar, pattern);
        for (const KernelMethod method : methods) {
            if (!run.go_on()) return;
            KernelRecord record;
            record.pattern = pattern;
            record.method = name(method);
            record.expected = kernel_dimension(pattern);
            std::vector<double> seconds;
            Eigen::MatrixXd basis;
            for (int repeat = 0; repeat < run.sizes.repeats; ++repeat) {
                const double begin = cpu_seconds();
                basis = kernel_space(method, bar, pattern);
                seconds.push_back(cpu_seconds() - begin);
                if (seconds.back() > slow_run) break;
            }
            record.seconds = spread(seconds);
            record.dimension = static_cast<int>(basis.cols());
            record.error = space_distance(basis, exact);
            run.sink.kernel(record);
        }
        if (!run.go_on()) return;
        Eigen::VectorXd tolerances(17);
        for (Eigen::Index i = 0; i < tolerances.size(); ++i)
            tolerances[i] = std::pow(10.0, static_cast<double>(i) - 17.0);
        for (const KernelMethod method : {KernelMethod::dense_svd, KernelMethod::rank_revealing_qr}) {
            // The neighbour shares few divisors with the window: long cycles, whose singular values
            // come near zero.
            for (const Pattern& one :
                 {pattern, Pattern{pattern.cells, pattern.free_steps - 1, pattern.contact_steps}}) {
                const Eigen::VectorXi found = dimensions_found(method, bar, one, tolerances);
                for (Eigen::Index i = 0; i < found.size(); ++i) {
                    run.sink.tolerance(
                        {one, std::string(name(method)), tolerances[i], found[i], kernel_dimension(one)});
                }
            }
        }
    }
}

}  // namespace nsma
