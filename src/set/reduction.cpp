#include "nsma/set/reduction.hpp"

#include <algorithm>
#include <unordered_map>

namespace nsma {
namespace {

constexpr long dominance_work_limit = 20'000'000;  // entries compared; beyond it rows are kept

// Live columns with their COND3 sign folded in, as presolve shrinks them.
struct Columns {
    std::vector<std::int8_t> flip;  // 0 once the column is known to be zero
    std::vector<std::uint8_t> bounded;
};

Columns fold_signs(const Conditions& conditions, RemovalCounts& removed) {
    const auto m = static_cast<std::size_t>(conditions.dimension());
    Columns columns{std::vector<std::int8_t>(m, 1), std::vector<std::uint8_t>(m, 1)};
    for (std::size_t j = 0; j < m; ++j) {
        switch (conditions.bound_of[j]) {
            case Conditions::Sign::free: columns.bounded[j] = 0; break;
            case Conditions::Sign::nonnegative: break;
            case Conditions::Sign::nonpositive: columns.flip[j] = -1; break;
            case Conditions::Sign::zero:
                columns.flip[j] = 0;
                ++removed.sign_conflicts;
                break;
        }
    }
    return columns;
}

// Walks the free flight once and fixes the columns of every row that has only nonnegative terms;
// counters of the positive and the other terms decide each row in O(1).
bool force_zeros(const Kernel& kernel, Columns& columns, std::vector<int>& sum, std::vector<ForcedZero>& forced) {
    std::fill(sum.begin(), sum.end(), 0);
    int positive = 0;
    int other = 0;  // negative terms of bounded columns and any term of a free column
    bool changed = false;
    for (int n = 0; n + 1 < kernel.pattern.free_steps; ++n) {
        const int j = kernel.column(n);
        if (j < 0) continue;
        const auto c = static_cast<std::size_t>(j);
        if (columns.flip[c] == 0) continue;
        const auto count = [&](int direction) {
            if (sum[c] == 0) return;
            (columns.bounded[c] != 0 && sum[c] > 0 ? positive : other) += direction;
        };
        count(-1);
        sum[c] += columns.flip[c] * kernel.sign[static_cast<std::size_t>(n)];
        count(+1);
        if (positive == 0 || other > 0) continue;
        for (std::size_t k = 0; k < sum.size(); ++k) {
            if (sum[k] == 0) continue;
            columns.flip[k] = 0;
            sum[k] = 0;
            forced.push_back({static_cast<int>(k), n + 1});
        }
        positive = 0;
        changed = true;
    }
    return changed;
}

std::size_t hash_row(const std::vector<int>& row) {
    std::size_t hash = 1469598103934665603U;  // FNV-1a
    for (const auto value : row) {
        hash ^= static_cast<std::size_t>(value);
        hash *= 1099511628211U;
    }
    return hash;
}

// Rows at the local maxima of the tip displacement: any other row is implied by a neighbour.
class RowCollector {
public:
    RowCollector(const Kernel& kernel, const Columns& columns, const std::vector<int>& reduced,
                 const std::vector<std::uint8_t>& bounded)
        : kernel_(kernel), columns_(columns), reduced_(reduced), bounded_(bounded), sum_(bounded.size(), 0) {}

    void collect(RemovalCounts& removed) {
        const int r = kernel_.pattern.free_steps;
        int pending = 0;  // step n of a row that only a downward or unknown step can make a maximum
        for (int n = 0; n < r; ++n) {
            const int direction = advance(n);
            if (direction == 0) {
                if (n + 1 < r) ++removed.silent_rows;
                continue;
            }
            if (pending > 0) {
                if (direction == up) {
                    ++removed.implied_rows;
                } else {
                    keep(pending, removed);
                }
            }
            apply(n);
            if (direction == down) {
                if (n + 1 < r) ++removed.implied_rows;
                pending = 0;
            } else {
                pending = n + 1;
            }
        }
        if (pending > 0 && pending < r) ++removed.implied_rows;  // row r is COND2 itself
    }

    std::vector<std::vector<int>> rows;
    std::vector<int> steps;

private:
    static constexpr int up = 1;
    static constexpr int down = -1;
    static constexpr int unknown = 2;

    int advance(int n) const {
        const int j = kernel_.column(n);
        if (j < 0) return 0;
        const auto c = static_cast<std::size_t>(j);
        if (columns_.flip[c] == 0) return 0;
        if (columns_.bounded[c] == 0) return unknown;
        return columns_.flip[c] * kernel_.sign[static_cast<std::size_t>(n)] > 0 ? up : down;
    }

    void apply(int n) {
        const auto c = static_cast<std::size_t>(kernel_.column(n));
        sum_[static_cast<std::size_t>(reduced_[c])] += columns_.flip[c] * kernel_.sign[static_cast<std::size_t>(n)];
    }

    void keep(int step, RemovalCounts& removed) {
        bool useful = false;  // a row without positive or free terms holds by the bounds
        for (std::size_t j = 0; j < sum_.size() && !useful; ++j) {
            useful = sum_[j] > 0 || (sum_[j] != 0 && bounded_[j] == 0);
        }
        if (!useful) {
            ++removed.implied_rows;
            return;
        }
        auto& bucket = seen_[hash_row(sum_)];
        for (const auto index : bucket) {
            if (rows[index] == sum_) {
                ++removed.duplicate_rows;
                return;
            }
        }
        bucket.push_back(rows.size());
        rows.push_back(sum_);
        steps.push_back(step);
    }

    const Kernel& kernel_;
    const Columns& columns_;
    const std::vector<int>& reduced_;
    const std::vector<std::uint8_t>& bounded_;
    std::vector<int> sum_;
    std::unordered_map<std::size_t, std::vector<std::size_t>> seen_;
};

// Row a is implied by row b when b - a >= 0 on bounded columns and = 0 on free ones.
bool dominates(const std::vector<int>& b, const std::vector<int>& a, const std::vector<std::uint8_t>& bounded) {
    for (std::size_t j = 0; j < a.size(); ++j) {
        if (b[j] < a[j] || (bounded[j] == 0 && b[j] != a[j])) return false;
    }
    return true;
}

std::vector<std::size_t> undominated(const std::vector<std::vector<int>>& rows,
                                     const std::vector<std::uint8_t>& bounded, RemovalCounts& removed) {
    std::vector<std::size_t> kept;
    const auto count = rows.size();
    const bool affordable =
        static_cast<long>(count) * static_cast<long>(count) * static_cast<long>(bounded.size()) <= dominance_work_limit;
    for (std::size_t a = 0; a < count; ++a) {
        bool implied = false;
        // Kept rows are distinct, so two rows never dominate each other.
        for (std::size_t b = 0; affordable && b < count && !implied; ++b) {
            implied = b != a && dominates(rows[b], rows[a], bounded);
        }
        if (implied) {
            ++removed.dominated_rows;
        } else {
            kept.push_back(a);
        }
    }
    return kept;
}

std::string emptiness(const Reduction& reduction) {
    if (reduction.column.empty()) {
        if (reduction.kernel_dimension == 0) return "the kernel is trivial";
        return "COND3 and COND1 leave no amplitude that can differ from zero";
    }
    if (reduction.gap_sign == 0 || reduction.has_free_variables()) return {};
    for (Eigen::Index j = 0; j < reduction.contact_row.size(); ++j) {
        if (reduction.gap_sign * reduction.contact_row[j] > 0) return {};
    }
    return "COND3 keeps the tip on one side: COND2 cannot hold";
}

}  // namespace

bool Reduction::has_free_variables() const {
    return std::find(bounded.begin(), bounded.end(), std::uint8_t{0}) != bounded.end();
}

Eigen::VectorXd Reduction::beta(const Eigen::VectorXd& gamma) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(kernel_dimension);
    for (std::size_t j = 0; j < column.size(); ++j) {
        result[column[j]] = flip[j] * gamma[static_cast<Eigen::Index>(j)] + 0.0;  // no negative zero
    }
    return result;
}

Eigen::VectorXd Reduction::gamma(const Eigen::VectorXd& beta) const {
    Eigen::VectorXd result(variables());
    for (std::size_t j = 0; j < column.size(); ++j) {
        result[static_cast<Eigen::Index>(j)] = flip[j] * beta[column[j]];
    }
    return result;
}

Reduction reduce(const Conditions& conditions) {
    const Kernel& kernel = conditions.kernel;
    Reduction reduction;
    reduction.gap_sign = conditions.gap_sign;
    reduction.energy_factor = conditions.energy_factor();
    reduction.kernel_dimension = conditions.dimension();
    auto& removed = reduction.removed;
    removed.dead_classes = kernel.classes - kernel.dimension();
    removed.contact_duplicates = kernel.pattern.contact_steps + 1;
    removed.force_rows = kernel.pattern.contact_steps;

    Columns columns = fold_signs(conditions, removed);
    std::vector<int> sum(columns.flip.size(), 0);
    while (force_zeros(kernel, columns, sum, reduction.forced)) {
    }
    removed.forced_zero = static_cast<int>(reduction.forced.size());

    std::vector<int> reduced(columns.flip.size(), -1);
    for (std::size_t c = 0; c < columns.flip.size(); ++c) {
        if (columns.flip[c] == 0) continue;
        reduced[c] = static_cast<int>(reduction.column.size());
        reduction.column.push_back(static_cast<int>(c));
        reduction.flip.push_back(columns.flip[c]);
        reduction.bounded.push_back(columns.bounded[c]);
    }
    const auto n = static_cast<Eigen::Index>(reduction.column.size());
    const Eigen::VectorXi tip = contact_row(kernel);
    reduction.contact_row.resize(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const auto k = static_cast<std::size_t>(j);
        reduction.contact_row[j] = reduction.flip[k] * tip[reduction.column[k]];
    }
    reduction.rows.resize(0, n);
    reduction.empty_because = emptiness(reduction);
    if (!reduction.empty_because.empty()) return reduction;

    RowCollector collector(kernel, columns, reduced, reduction.bounded);
    collector.collect(removed);
    const auto kept = undominated(collector.rows, reduction.bounded, removed);
    reduction.rows.resize(static_cast<Eigen::Index>(kept.size()), n);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        for (Eigen::Index j = 0; j < n; ++j) {
            reduction.rows(static_cast<Eigen::Index>(i), j) = collector.rows[kept[i]][static_cast<std::size_t>(j)];
        }
        reduction.row_step.push_back(collector.steps[kept[i]]);
    }
    return reduction;
}

}  // namespace nsma
