#include "nsma/set/reduction.hpp"

#include <algorithm>

namespace nsma {
namespace {

using Sign = Conditions::Sign;

// The rows that COND3 makes sums of nonnegative terms: the first in which a class rises above zero, and the next ones,
// in which the other classes follow. Empty, or one for each column.
std::vector<ForcedZero> forced_zeros(const Kernel& kernel, int flip) {
    const auto m = static_cast<std::size_t>(kernel.dimension());
    std::vector<int> height(m, 0);
    std::vector<ForcedZero> forced;
    kernel.for_each_live(0, kernel.pattern.free_steps - 1, [&](int n, std::size_t column, int sign) {
        height[column] += flip * sign;
        if (height[column] > 0 && forced.size() < m) forced.push_back({static_cast<int>(column), n + 1});
    });
    return forced;
}

std::string emptiness(const Reduction& reduction) {
    if (reduction.kernel_dimension == 0) return "the kernel is trivial";
    if (reduction.variables() == 0) return "COND3 and COND1 leave no amplitude that can differ from zero";
    if (reduction.bounded && reduction.gap_sign != 0 && reduction.gap_sign * reduction.contact_row[0] <= 0)
        return "COND3 keeps the tip on one side: COND2 cannot hold";
    return {};
}

// COND1 without bounds: the partial sums from either end, in the order of their steps.
void keep_partial_sums(const Kernel& kernel, Reduction& reduction) {
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    reduction.rows = Eigen::MatrixXi::Zero(2 * n - 1, n);
    for (Eigen::Index k = 1; k <= n; ++k) {
        reduction.rows.row(k - 1).head(k).setOnes();
        if (k < n) reduction.rows.row(n + k - 1).tail(n - k).setOnes();
    }
    const int first = kernel.class_of.front();
    for (int k = 1; k <= n; ++k) reduction.row_step.push_back(first + k);
    for (int k = 1; k < n; ++k) reduction.row_step.push_back(kernel.classes + first + k);
}

// Every COND1 row is accounted for: live steps change it, others leave it as it was.
void count_rows(const Kernel& kernel, const Reduction& reduction, RemovalCounts& removed) {
    const int rows = kernel.pattern.free_steps - 1;
    const auto live = static_cast<int>(rows - std::count(kernel.sign.begin(), kernel.sign.begin() + rows, 0));
    removed.silent_rows = rows - live;
    const int rounds = kernel.pattern.period_steps() / kernel.classes;
    // Without bounds each second round but the last, whose end is COND2, ends with a row of zeros.
    removed.implied_rows = reduction.bounded ? live : rounds / 2 - 1;
    removed.duplicate_rows = live - removed.implied_rows - static_cast<int>(reduction.rows.rows());
}

}  // namespace

Eigen::VectorXd Reduction::beta(const Eigen::VectorXd& gamma) const {
    if (variables() == 0) return Eigen::VectorXd::Zero(kernel_dimension);
    return (flip * gamma.array() + 0.0).matrix();  // no negative zero
}

Eigen::VectorXd Reduction::gamma(const Eigen::VectorXd& beta) const { return flip * beta.head(variables()); }

Reduction reduce(const Conditions& conditions) {
    const Kernel& kernel = conditions.kernel;
    const Sign sign = kernel.dimension() > 0 ? conditions.bound_of.front() : Sign::free;
    Reduction reduction;
    reduction.gap_sign = conditions.gap_sign;
    reduction.energy_factor = conditions.energy_factor();
    reduction.kernel_dimension = kernel.dimension();
    reduction.flip = sign == Sign::nonpositive ? -1 : 1;
    reduction.bounded = sign != Sign::free;
    auto& removed = reduction.removed;
    removed.dead_classes = kernel.classes - kernel.dimension();
    removed.contact_duplicates = kernel.pattern.contact_steps + 1;
    removed.force_rows = kernel.pattern.contact_steps;
    if (sign == Sign::zero) {
        removed.sign_conflicts = kernel.dimension();
    } else if (reduction.bounded) {
        reduction.forced = forced_zeros(kernel, reduction.flip);
        removed.forced_zero = static_cast<int>(reduction.forced.size());
    }
    if (sign != Sign::zero && reduction.forced.empty()) reduction.contact_row = reduction.flip * contact_row(kernel);
    reduction.rows.resize(0, reduction.variables());
    reduction.empty_because = emptiness(reduction);
    if (!reduction.empty_because.empty()) return reduction;
    if (!reduction.bounded) keep_partial_sums(kernel, reduction);
    count_rows(kernel, reduction, removed);
    return reduction;
}

}  // namespace nsma
