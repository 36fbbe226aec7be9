// The checker of certificates. It takes nothing from the program that writes them: kernel signs
// are integers, everything else is fractions.
#include <algorithm>
#include <numeric>
#include <set>

#include "nsma/orbit/conditions.hpp"
#include "nsma/program/certificate.hpp"

namespace nsma {
namespace {

// Beyond these a certificate is refused, so that a forged size cannot exhaust the machine.
constexpr int checked_cells = 1'000'000;
constexpr int checked_steps = 2'000'000;
constexpr std::size_t chain_values = 400;

struct Invalid {
    std::string reason;
};
[[noreturn]] void invalid(std::string reason) { throw Invalid{std::move(reason)}; }

std::string column_name(int column) { return "column " + std::to_string(column); }

class Checker {
public:
    explicit Checker(const Certificate& certificate)
        : certificate_(certificate), kernel_(exact_kernel(certificate.pattern)),
          signs_(conditions(kernel_, certificate.gap_sign).bound_of),
          dimension_(static_cast<std::size_t>(kernel_.dimension())) {
        const Eigen::VectorXi row = contact_row(kernel_);
        contact_.assign(row.data(), row.data() + row.size());
        const auto& pattern = certificate.pattern;
        factor_ = Rational(Integer(4) * pattern.cells * pattern.cells, pattern.class_count());
    }

    void run() {
        switch (certificate_.claim) {
            case Certificate::Claim::trivial:
                if (dimension_ != 0) invalid("claim: expected a kernel of dimension 0, got " + std::to_string(dimension_));
                expect_no_energies("a trivial kernel");
                return;
            case Certificate::Claim::empty: check_empty(); return;
            case Certificate::Claim::nonempty: check_nonempty(); return;
        }
        invalid("claim: unknown");
    }

    [[nodiscard]] Rational energy_bound() const {
        const auto& proof = certificate_.greatest_proof;
        return factor_ * (proof.tree.empty() ? chain_bound(proof) : tree_bound(proof));
    }

private:
    using Dense = std::vector<Rational>;
    using Sign = Conditions::Sign;

    [[nodiscard]] Dense dense(const RationalVector& sparse, const char* what) const {
        Dense result(dimension_);
        int last = -1;
        for (const auto& [column, value] : sparse) {
            if (column <= last || column >= static_cast<int>(dimension_)) {
                invalid(std::string(what) + ": expected increasing columns below " +
                        std::to_string(dimension_) + ", got " + std::to_string(column));
            }
            last = column;
            result[static_cast<std::size_t>(column)] = value;
        }
        return result;
    }

    // sum_n y_n a_n over the columns: step k carries the sum of y_n over n > k.
    [[nodiscard]] Dense combine_rows(const RationalVector& rows) const {
        int last = 0;
        for (const auto& [n, y] : rows) {
            if (n <= last || n >= certificate_.pattern.free_steps) {
                invalid("rows: expected increasing steps in 1.." +
                        std::to_string(certificate_.pattern.free_steps - 1) + ", got " + std::to_string(n));
            }
            if (y < 0) invalid("COND1 row " + std::to_string(n) + ": multiplier is negative");
            last = n;
        }
        Dense result(dimension_);
        Rational weight;
        int end = rows.empty() ? 0 : rows.back().first;
        for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
            const int begin = std::next(row) == rows.rend() ? 0 : std::next(row)->first;
            weight += row->second;
            // Steps begin..end-1 all carry the same weight: count their signs first.
            std::vector<int> count(dimension_, 0);
            for (int k = begin; k < end; ++k) {
                const int column = kernel_.column(k);
                if (column >= 0) count[static_cast<std::size_t>(column)] += kernel_.sign[static_cast<std::size_t>(k)];
            }
            for (std::size_t c = 0; c < dimension_; ++c) {
                if (count[c] != 0) result[c] += weight * count[c];
            }
            end = begin;
        }
        return result;
    }

    // form - combination; its positive part on COND3's cone would break the bound.
    [[nodiscard]] Dense remainder(const Dense& form, const RowCombination& combination) const {
        Dense result = combine_rows(combination.rows);
        for (std::size_t c = 0; c < dimension_; ++c) {
            result[c] = form[c] - result[c] - combination.contact * contact_[c];
        }
        return result;
    }

    // Proved upper bound of the form over the admissible set.
    [[nodiscard]] Rational verified(const FormBound& bound) const {
        const Dense rest = remainder(dense(bound.form, "form"), bound.proof);
        for (std::size_t c = 0; c < dimension_; ++c) {
            const bool dominated = signs_[c] == Sign::zero ||
                                   (signs_[c] == Sign::free && rest[c] == 0) ||
                                   (signs_[c] == Sign::nonnegative && rest[c] <= 0) ||
                                   (signs_[c] == Sign::nonpositive && rest[c] >= 0);
            if (!dominated) invalid("bound: multipliers do not dominate " + column_name(static_cast<int>(c)));
        }
        return bound.proof.contact * certificate_.gap_sign;
    }

    // COND1 and COND3 (a cone); COND2 is the caller's.
    void check_cone(const Dense& beta, const std::string& what) const {
        for (std::size_t c = 0; c < dimension_; ++c) {
            const bool allowed = signs_[c] == Sign::free || beta[c] == 0 ||
                                 (signs_[c] == Sign::nonnegative && beta[c] > 0) ||
                                 (signs_[c] == Sign::nonpositive && beta[c] < 0);
            if (!allowed) invalid(what + ": COND3 fails at " + column_name(static_cast<int>(c)));
        }
        Integer common = 1;
        for (const auto& value : beta) common = lcm(common, denominator(value));
        std::vector<Integer> scaled(dimension_);
        for (std::size_t c = 0; c < dimension_; ++c) {
            scaled[c] = numerator(beta[c]) * (common / denominator(beta[c]));
        }
        Integer sum = 0;
        for (int k = 0; k < certificate_.pattern.free_steps; ++k) {
            const int column = kernel_.column(k);
            if (column < 0) continue;
            const auto c = static_cast<std::size_t>(column);
            if (kernel_.sign[static_cast<std::size_t>(k)] > 0) sum += scaled[c]; else sum -= scaled[c];
            if (sum > 0) invalid(what + ": COND1 row " + std::to_string(k + 1) + " fails");
        }
        if (sum != 0) invalid(what + ": the tip does not return to the wall");
    }

    [[nodiscard]] Rational contact_value(const Dense& beta) const {
        Rational sum;
        for (std::size_t c = 0; c < dimension_; ++c) sum += beta[c] * contact_[c];
        return sum;
    }

    [[nodiscard]] static Rational square(const Dense& beta) {
        Rational sum;
        for (const auto& value : beta) sum += value * value;
        return sum;
    }

    // rho: delta w minus the combination, projected on COND3's cone.
    [[nodiscard]] Dense projection() const {
        Dense result = combine_rows(certificate_.projection);
        for (std::size_t c = 0; c < dimension_; ++c) {
            result[c] = Rational(certificate_.gap_sign * contact_[c]) - result[c];
            const bool clipped = signs_[c] == Sign::zero || (signs_[c] == Sign::nonnegative && result[c] < 0) ||
                                 (signs_[c] == Sign::nonpositive && result[c] > 0);
            if (clipped) result[c] = 0;
        }
        return result;
    }

    void expect_no_energies(const char* of) const {
        if (certificate_.energy_least || certificate_.energy_attained || certificate_.energy_bound) {
            invalid(std::string("energies: expected none for ") + of);
        }
    }

    void check_empty() const {
        if (dimension_ == 0) invalid("claim: expected a nontrivial kernel, got dimension 0");
        expect_no_energies("an empty set");
        if (certificate_.gap_sign == 0) {
            check_only_rest();
            return;
        }
        const Dense rho = projection();
        for (std::size_t c = 0; c < dimension_; ++c) {
            if (rho[c] != 0) invalid("Farkas vector: " + column_name(static_cast<int>(c)) + " is left over");
        }
    }

    // Forms proved <= 0: first the sum of |beta_c| over COND3's columns, then +-beta_c of the others.
    void check_only_rest() const {
        std::set<std::pair<int, int>> free_bounded;
        bool bounded_zero = std::none_of(signs_.begin(), signs_.end(), [](Sign s) {
            return s == Sign::nonnegative || s == Sign::nonpositive;
        });
        for (const auto& bound : certificate_.rest) {
            if (verified(bound) > 0) invalid("rest: a form is not proved <= 0");
            const Dense form = dense(bound.form, "form");
            bool covers = true;
            for (std::size_t c = 0; c < dimension_; ++c) {
                covers = covers && (signs_[c] != Sign::nonnegative || form[c] > 0) &&
                         (signs_[c] != Sign::nonpositive || form[c] < 0) &&
                         (signs_[c] != Sign::free || form[c] == 0);
            }
            bounded_zero = bounded_zero || covers;
            if (bound.form.size() == 1) {
                free_bounded.insert({bound.form[0].first, bound.form[0].second > 0 ? 1 : -1});
            }
        }
        if (!bounded_zero) invalid("rest: no form bounds every column of COND3");
        for (std::size_t c = 0; c < dimension_; ++c) {
            if (signs_[c] != Sign::free) continue;
            const int column = static_cast<int>(c);
            if (!free_bounded.contains({column, 1}) || !free_bounded.contains({column, -1})) {
                invalid("rest: " + column_name(column) + " is not bounded from both sides");
            }
        }
    }

    void check_nonempty() const {
        if (certificate_.gap_sign == 0) {
            check_ray();
            expect_no_energies("a closed gap");
            return;
        }
        const Dense rho = projection();
        const Rational length = square(rho);
        if (length == 0) invalid("least-energy point: the projection is zero");
        check_cone(rho, "least-energy point");
        // delta w . rho = |rho|^2 makes rho/|rho|^2 meet COND2 and proves that nothing is nearer.
        if (contact_value(rho) * certificate_.gap_sign != length) invalid("least-energy point: COND2 fails");
        if (!certificate_.energy_least || *certificate_.energy_least != factor_ / length) {
            invalid("energy_least: expected " + to_string(factor_ / length));
        }
        if (!certificate_.ray.empty()) {
            check_ray();
            if (certificate_.energy_bound) invalid("energy_bound: expected none along a ray");
        }
        check_greatest(factor_ / length);
    }

    void check_ray() const {
        const Dense ray = dense(certificate_.ray, "ray");
        if (square(ray) == 0) invalid("ray: expected a nonzero direction");
        check_cone(ray, "ray");
        if (contact_value(ray) != 0) invalid("ray: COND2 fails");
    }

    void check_greatest(const Rational& least) const {
        if (certificate_.greatest.empty()) {
            if (certificate_.energy_attained) invalid("energy_attained: expected a point");
        } else {
            const Dense point = dense(certificate_.greatest, "greatest");
            check_cone(point, "greatest-energy point");
            if (contact_value(point) != certificate_.gap_sign) invalid("greatest-energy point: COND2 fails");
            const Rational energy = factor_ * square(point);
            if (!certificate_.energy_attained || *certificate_.energy_attained != energy) {
                invalid("energy_attained: expected " + to_string(energy));
            }
        }
        if (!certificate_.energy_bound) return;
        const Rational bound = energy_bound();
        if (bound > *certificate_.energy_bound) invalid("energy_bound: proved only " + to_string(bound));
        if (*certificate_.energy_bound < least) invalid("energy_bound: below the least energy");
    }

    // Bounds of every column that can differ from zero.
    void read_box(const GreatestProof& proof, Dense& lower, Dense& upper) const {
        std::vector<int> seen(dimension_, 0);
        for (const auto& bound : proof.box) {
            const Rational value = verified(bound);
            if (bound.form.size() != 1) invalid("box: expected forms of one column");
            const auto c = static_cast<std::size_t>(bound.form[0].first);
            const Rational& coefficient = bound.form[0].second;
            if (coefficient == 1) {
                upper[c] = value;
                seen[c] |= 1;
            } else if (coefficient == -1) {
                lower[c] = -value;
                seen[c] |= 2;
            } else {
                invalid("box: expected a coefficient 1 or -1");
            }
        }
        for (std::size_t c = 0; c < dimension_; ++c) {
            if (signs_[c] != Sign::zero && seen[c] != 3) invalid("box: no bounds of " + column_name(static_cast<int>(c)));
        }
    }

    [[nodiscard]] Rational tree_bound(const GreatestProof& proof) const {
        Dense lower(dimension_);
        Dense upper(dimension_);
        read_box(proof, lower, upper);
        struct Open {
            int node;
            Dense lower;
            Dense upper;
        };
        std::vector<Open> open{{0, lower, upper}};
        std::optional<Rational> greatest;
        while (!open.empty()) {
            Open here = std::move(open.back());
            open.pop_back();
            const auto& node = proof.tree[static_cast<std::size_t>(here.node)];
            if (node.split_column < 0) {
                const Rational value = leaf_bound(node.leaf, here.lower, here.upper);
                if (!greatest || value > *greatest) greatest = value;
                continue;
            }
            if (node.split_column >= static_cast<int>(dimension_)) invalid("tree: unknown " + column_name(node.split_column));
            const auto c = static_cast<std::size_t>(node.split_column);
            const auto count = static_cast<int>(proof.tree.size());
            for (const int child : {node.low, node.high}) {
                // Children come after their parent, so the walk ends.
                if (child <= here.node || child >= count) invalid("tree: expected children after node " + std::to_string(here.node));
            }
            Open high{node.high, here.lower, here.upper};
            high.lower[c] = std::max(high.lower[c], node.split_at);
            here.node = node.low;
            here.upper[c] = std::min(here.upper[c], node.split_at);
            if (here.lower[c] <= here.upper[c]) open.push_back(std::move(here));
            if (high.lower[c] <= high.upper[c]) open.push_back(std::move(high));
            if (++visited_ > 4 * proof.tree.size()) invalid("tree: a node is visited too often");
        }
        return greatest.value_or(Rational(0));
    }

    // beta^2 <= (l + u) beta - l u in the box; the form that remains is bounded by the box.
    [[nodiscard]] Rational leaf_bound(const RowCombination& leaf, const Dense& lower, const Dense& upper) const {
        Dense secant(dimension_);
        Rational value = leaf.contact * certificate_.gap_sign;
        for (std::size_t c = 0; c < dimension_; ++c) {
            secant[c] = lower[c] + upper[c];
            value -= lower[c] * upper[c];
        }
        const Dense rest = remainder(secant, leaf);
        for (std::size_t c = 0; c < dimension_; ++c) {
            if (signs_[c] != Sign::zero) value += std::max<Rational>(rest[c] * lower[c], rest[c] * upper[c]);
        }
        return value;
    }

    [[nodiscard]] Rational chain_bound(const GreatestProof& proof) const {
        std::vector<int> seen(dimension_, 0);
        for (const int column : proof.chain) {
            if (column < 0 || column >= static_cast<int>(dimension_)) invalid("chain: unknown " + column_name(column));
            const auto c = static_cast<std::size_t>(column);
            if (seen[c]++ != 0 || contact_[c] == 0) invalid("chain: " + column_name(column) + " cannot be chained");
        }
        for (std::size_t c = 0; c < dimension_; ++c) {
            if (signs_[c] != Sign::zero && seen[c] == 0) invalid("chain: " + column_name(static_cast<int>(c)) + " is missing");
        }
        const std::size_t n = proof.chain.size();
        if (n == 0 || proof.chain_bounds.size() != 2 * (n - 1)) invalid("chain: expected two bounds a partial sum");
        std::vector<Rational> lower(n + 1);
        std::vector<Rational> upper(n + 1);
        lower[n] = upper[n] = 1;
        Dense partial(dimension_);
        std::set<Rational> values{Rational(0), Rational(1)};
        for (std::size_t k = 1; k < n; ++k) {
            const auto c = static_cast<std::size_t>(proof.chain[k - 1]);
            partial[c] = certificate_.gap_sign * contact_[c];
            for (const int side : {1, -1}) {
                const auto& bound = proof.chain_bounds[2 * (k - 1) + (side > 0 ? 0 : 1)];
                const Dense form = dense(bound.form, "form");
                for (std::size_t j = 0; j < dimension_; ++j) {
                    if (form[j] != side * partial[j]) invalid("chain: bound " + std::to_string(k) + " is of another form");
                }
                (side > 0 ? upper : lower)[k] = side * verified(bound);
            }
            values.insert(lower[k]);
            values.insert(upper[k]);
        }
        if (values.size() > chain_values) invalid("chain: too many different bounds");
        return best_chain(proof.chain, lower, upper, {values.begin(), values.end()});
    }

    // A convex sum of squared steps over bounds and known directions of steps is greatest at a
    // vertex, and there every partial sum equals one of the bounds.
    [[nodiscard]] Rational best_chain(const std::vector<int>& chain, const std::vector<Rational>& lower,
                                      const std::vector<Rational>& upper, const std::vector<Rational>& values) const {
        std::vector<std::optional<Rational>> best(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] == 0) best[i] = 0;
        }
        for (std::size_t k = 0; k < chain.size(); ++k) {
            const auto c = static_cast<std::size_t>(chain[k]);
            const int weight = certificate_.gap_sign * contact_[c];
            int direction = signs_[c] == Sign::nonnegative ? 1 : signs_[c] == Sign::nonpositive ? -1 : 0;
            if (weight < 0) direction = -direction;
            const bool fixed = signs_[c] == Sign::zero;
            std::vector<std::optional<Rational>> next(values.size());
            for (std::size_t to = 0; to < values.size(); ++to) {
                if (values[to] < lower[k + 1] || values[to] > upper[k + 1]) continue;
                for (std::size_t from = 0; from < values.size(); ++from) {
                    if (!best[from] || (fixed && from != to)) continue;
                    if ((direction > 0 && to < from) || (direction < 0 && to > from)) continue;
                    const Rational step = (values[to] - values[from]) / weight;
                    Rational total = *best[from] + step * step;
                    if (!next[to] || total > *next[to]) next[to] = std::move(total);
                }
            }
            best = std::move(next);
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] == 1 && best[i]) return *best[i];
        }
        invalid("chain: its bounds exclude one another");
    }

    const Certificate& certificate_;
    Kernel kernel_;
    std::vector<Sign> signs_;
    std::size_t dimension_;
    std::vector<int> contact_;
    Rational factor_;
    mutable std::size_t visited_ = 0;
};

}  // namespace

namespace {

// Empty when the four integers are within what the checker takes.
std::string refusal(const Certificate& certificate) {
    const auto& pattern = certificate.pattern;
    if (pattern.cells < 1 || pattern.cells > checked_cells || pattern.free_steps < 1 ||
        pattern.contact_steps < 1 || pattern.free_steps > checked_steps ||
        pattern.contact_steps > checked_steps) {
        return "pattern: expected cells in 1.." + std::to_string(checked_cells) +
               " and steps in 1.." + std::to_string(checked_steps);
    }
    if (certificate.gap_sign < -1 || certificate.gap_sign > 1) {
        return "gap_sign: expected -1, 0 or 1, got " + std::to_string(certificate.gap_sign);
    }
    return {};
}

}  // namespace

CheckResult check(const Certificate& certificate) {
    if (auto reason = refusal(certificate); !reason.empty()) return {false, std::move(reason)};
    try {
        Checker(certificate).run();
    } catch (const Invalid& failure) {
        return {false, failure.reason};
    }
    return {true, {}};
}

std::optional<Rational> proved_energy_bound(const Certificate& certificate) {
    if (!refusal(certificate).empty()) return std::nullopt;
    try {
        return Checker(certificate).energy_bound();
    } catch (const Invalid&) {
        return std::nullopt;
    }
}

}  // namespace nsma
