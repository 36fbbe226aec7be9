#include "known_set.hpp"

#include <algorithm>
#include <set>

namespace nsma {
namespace {

using Shape = AdmissibleSet::Shape;

// Up to so many partial sums every vertex is kept.
constexpr std::size_t all_sums = 6;

// Steps between the partial sums, P_0 = 0 and P_n = 1, in units of -delta/c.
Eigen::VectorXd steps_of(const std::vector<char>& high) {
    Eigen::VectorXd steps(static_cast<Eigen::Index>(high.size()) + 1);
    int before = 0;
    for (std::size_t k = 0; k < high.size(); ++k) {
        steps[static_cast<Eigen::Index>(k)] = high[k] - before;
        before = high[k];
    }
    steps[steps.size() - 1] = 1 - before;
    return steps;
}

std::vector<Eigen::VectorXd> chain_vertices(Eigen::Index n) {
    const auto inner = static_cast<std::size_t>(n) - 1;
    std::vector<Eigen::VectorXd> steps;
    std::set<std::vector<char>> seen;
    const auto keep = [&](const std::vector<char>& high) {
        if (seen.insert(high).second) steps.push_back(steps_of(high));
    };
    std::vector<char> high(inner);
    // Alternating steps; where n is even one step is zero, and the sums after it are the other way round.
    for (std::size_t zero = 0; zero < (n % 2 == 0 ? static_cast<std::size_t>(n) : 1U); ++zero) {
        for (std::size_t k = 0; k < inner; ++k)
            high[k] = static_cast<char>((k + (n % 2 == 0 && k >= zero ? 1U : 0U)) % 2 == 0);
        keep(high);
    }
    const auto greatest = steps.size();
    if (inner <= all_sums) {
        for (unsigned bits = 0; bits < (1U << inner); ++bits) {
            for (std::size_t k = 0; k < inner; ++k) high[k] = static_cast<char>(bits >> k & 1U);
            keep(high);
        }
    }
    for (const std::size_t run : {2U, 3U, 4U}) {
        for (std::size_t shift = 0; shift < 2 * run; ++shift) {
            for (std::size_t k = 0; k < inner; ++k) high[k] = static_cast<char>((k + shift) / run % 2 == 0);
            keep(high);
        }
    }
    for (std::size_t jump = 0; jump <= inner; ++jump) {
        for (std::size_t k = 0; k < inner; ++k) high[k] = static_cast<char>(k >= jump);
        keep(high);
    }
    std::stable_sort(steps.begin() + static_cast<std::ptrdiff_t>(greatest), steps.end(),
                     [](const auto& a, const auto& b) { return a.squaredNorm() > b.squaredNorm(); });
    return steps;
}

void refuse(AdmissibleSet& set, const char* reason) {
    set.status = AdmissibleSet::Status::empty;
    set.reason = reason;
}

}  // namespace

ChainRows chain_rows(const Reduction& reduction) {
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    const std::vector<int> none(static_cast<std::size_t>(n) + 1, -1);
    ChainRows result{none, none};
    for (Eigen::Index i = 0; i < reduction.rows.rows(); ++i) {
        const auto row = reduction.rows.row(i);
        Eigen::Index first = 0;
        while (first < n && row[first] == 0) ++first;
        Eigen::Index last = first;
        while (last < n && row[last] == 1) ++last;
        const bool only_ones = row.sum() == last - first && row.cwiseAbs().sum() == last - first;
        if (first == last || (first > 0 && last < n) || !only_ones) return {};
        if (first == 0) {
            result.prefix[static_cast<std::size_t>(last)] = static_cast<int>(i);
        } else {
            result.suffix[static_cast<std::size_t>(first)] = static_cast<int>(i);
        }
    }
    return result;
}

Shape shape_of(const Reduction& reduction) {
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    if (n == 0) return Shape::none;
    const int weight = reduction.contact_row[0];
    if ((reduction.contact_row.array() != weight).any()) return Shape::none;
    const auto bounded = std::count(reduction.bounded.begin(), reduction.bounded.end(), std::uint8_t{1});
    if (bounded == n && reduction.rows.rows() == 0) return Shape::simplex;
    if (bounded > 0 || weight >= 0) return Shape::none;
    const ChainRows rows = chain_rows(reduction);
    if (rows.prefix.empty()) return Shape::none;
    for (std::size_t k = 1; k < static_cast<std::size_t>(n); ++k) {
        if (rows.prefix[k] < 0 || rows.suffix[k] < 0) return Shape::none;
    }
    return Shape::chain;
}

void decide_in_closed_form(AdmissibleSet& set) {
    const Reduction& data = set.reduction;
    const auto n = static_cast<Eigen::Index>(data.variables());
    const int weight = data.contact_row[0];
    if (set.shape == Shape::chain && data.gap_sign <= 0) {
        return refuse(set, data.gap_sign < 0 ? "partial sums: the tip cannot be beyond where it starts"
                                             : "partial sums: only rest meets COND1-3 at a closed gap");
    }
    if (data.gap_sign == 0 && weight != 0) return refuse(set, "COND3 and COND2: only rest meets them at a closed gap");
    set.status = AdmissibleSet::Status::nonempty;
    if (data.gap_sign == 0) {
        set.ray = Eigen::VectorXd::Constant(n, 1.0).normalized();
        for (Eigen::Index j = 0; j < n; ++j) set.vertices.push_back(Eigen::VectorXd::Unit(n, j));
        return;
    }
    const double share = static_cast<double>(data.gap_sign) / weight;
    set.least = Eigen::VectorXd::Constant(n, share / static_cast<double>(n));
    if (set.shape == Shape::simplex) {
        for (Eigen::Index j = 0; j < n; ++j) set.vertices.push_back(share * Eigen::VectorXd::Unit(n, j));
    } else {
        set.vertices = chain_vertices(n);
        for (auto& vertex : set.vertices) vertex *= share;
    }
}

}  // namespace nsma
