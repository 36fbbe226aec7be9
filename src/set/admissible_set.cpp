#include "nsma/set/admissible_set.hpp"

#include <algorithm>
#include <set>

namespace nsma {
namespace {

using Shape = AdmissibleSet::Shape;
using Status = AdmissibleSet::Status;

// Up to so many partial sums every vertex is kept.
constexpr std::size_t all_sums = 6;

// Steps between the partial sums, P_0 = 0 and P_n = 1, in units of -delta/c.
Eigen::VectorXd steps_of(const std::vector<char>& high) {
    Eigen::VectorXd steps(static_cast<Eigen::Index>(high.size()) + 1);
    int before = 0;
    for (std::size_t k = 0; k < high.size(); ++k) {
        const int now = high[k] != 0 ? 1 : 0;
        steps[static_cast<Eigen::Index>(k)] = now - before;
        before = now;
    }
    steps[steps.size() - 1] = 1 - before;
    return steps;
}

// Vertices of a chain in units of -delta/c: all of the greatest energy (steps of alternating sign, one of them zero
// where n is even), up to seven columns every one, the single steps, and those whose P_k changes after every 2, 3 or 4
// columns, of all 2^(n-1).
std::vector<Eigen::VectorXd> chain_vertices(Eigen::Index n) {
    const auto inner = static_cast<std::size_t>(n) - 1;
    std::vector<Eigen::VectorXd> steps;
    std::set<std::vector<char>> seen;
    std::vector<char> high(inner);
    const auto keep = [&](const auto& is_high) {
        for (std::size_t k = 0; k < inner; ++k) high[k] = static_cast<char>(is_high(k));
        if (seen.insert(high).second) steps.push_back(steps_of(high));
    };
    // Where n is even one step is zero, and the sums after it are the other way round.
    for (std::size_t zero = 0; zero < (n % 2 == 0 ? static_cast<std::size_t>(n) : 1U); ++zero)
        keep([&](std::size_t k) { return (k + (n % 2 == 0 && k >= zero ? 1U : 0U)) % 2 == 0; });
    const auto greatest = static_cast<std::ptrdiff_t>(steps.size());
    if (inner <= all_sums) {
        for (unsigned bits = 0; bits < (1U << inner); ++bits)
            keep([&](std::size_t k) { return (bits >> k & 1U) != 0; });
    }
    for (const std::size_t run : {2U, 3U, 4U}) {
        for (std::size_t shift = 0; shift < 2 * run; ++shift)
            keep([&](std::size_t k) { return (k + shift) / run % 2 == 0; });
    }
    for (std::size_t jump = 0; jump <= inner; ++jump) keep([&](std::size_t k) { return k >= jump; });
    std::stable_sort(steps.begin() + greatest, steps.end(),
                     [](const auto& a, const auto& b) { return a.squaredNorm() > b.squaredNorm(); });
    return steps;
}

std::vector<Eigen::VectorXd> unit_vectors(Eigen::Index n) {
    std::vector<Eigen::VectorXd> units;
    for (Eigen::Index j = 0; j < n; ++j) units.push_back(Eigen::VectorXd::Unit(n, j));
    return units;
}

// Why a set whose COND3 and COND1 leave some amplitudes is empty; empty text where it is not.
std::string emptiness(Shape shape, int gap_sign, int weight) {
    if (shape == Shape::chain && gap_sign < 0) return "partial sums: the tip cannot be beyond where it starts";
    if (shape == Shape::chain && gap_sign == 0) return "partial sums: only rest meets COND1-3 at a closed gap";
    if (gap_sign == 0 && weight != 0) return "COND3 and COND2: only rest meets them at a closed gap";
    return {};
}

}  // namespace

double AdmissibleSet::energy(const Eigen::VectorXd& gamma) const {
    return reduction.energy_factor * gamma.squaredNorm();
}

EnergyInterval AdmissibleSet::interval() const {
    EnergyInterval interval;
    if (status != Status::nonempty) return interval;
    interval.least = reduction.gap_sign == 0 ? 0.0 : energy(least);
    interval.unbounded = unbounded();
    if (!interval.unbounded) interval.greatest = std::max(*interval.least, energy(vertices.front()));
    return interval;
}

AdmissibleSet admissible_set(Reduction reduction) {
    AdmissibleSet set;
    set.reduction = std::move(reduction);
    const Reduction& data = set.reduction;
    set.reason = data.empty_because;
    if (!set.reason.empty()) return set;
    const auto n = static_cast<Eigen::Index>(data.variables());
    const int weight = data.contact_row[0];
    set.shape = data.bounded ? Shape::simplex : Shape::chain;
    set.reason = emptiness(set.shape, data.gap_sign, weight);
    if (!set.reason.empty()) return set;
    set.status = Status::nonempty;
    set.vertices = set.shape == Shape::simplex ? unit_vectors(n) : chain_vertices(n);
    if (data.gap_sign == 0) {
        set.ray = Eigen::VectorXd::Ones(n).normalized();
        return set;
    }
    const double share = static_cast<double>(data.gap_sign) / weight;
    set.least = Eigen::VectorXd::Constant(n, share / static_cast<double>(n));
    for (auto& vertex : set.vertices) vertex *= share;
    return set;
}

}  // namespace nsma
