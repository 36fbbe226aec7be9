#include "tied_optima.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "nsma/numerics/interruption.hpp"
#include "nsma/set/admissible_set.hpp"
#include "search/orbit_program.hpp"

namespace nsma {
namespace {

// Amplitudes, conditions and objectives of copies differ by rounding only.
constexpr double same = 1e-10;
// Each is an analysis of its own.
constexpr std::size_t most_ties = 1'000;

using Eigen::VectorXd;

class Ties {
public:
    Ties(const RelaxedSet& set, Objective objective, const VectorXd& beta, const VectorXd& reference)
        : set_(set),
          objective_(objective),
          beta_(beta),
          reference_(reference),
          value_(value(beta)),
          size_(std::max(beta.cwiseAbs().maxCoeff(), 1e-300)) {}

    TiedOptima find() {
        if (objective_ == Objective::max_energy) {
            for (const VectorXd& vertex : vertices_of_greatest_energy(set_.kernel, set_.gap_sign)) add(vertex);
            return std::move(result_);
        }
        shifts();
        permutations();
        return std::move(result_);
    }

private:
    [[nodiscard]] double value(const VectorXd& beta) const {
        return objective_of_waves(set_.kernel, objective_, beta, reference_);
    }

    void add(const VectorXd& beta) {
        const auto equals = [&](const VectorXd& other) { return (beta - other).cwiseAbs().maxCoeff() <= same * size_; };
        if (equals(beta_) || std::any_of(result_.others.begin(), result_.others.end(), equals)) return;
        const double slack = same * (1.0 + size_ * static_cast<double>(2 * set_.kernel.pattern.cells));
        const VectorXd limits = set_.limits({});
        if (limits.size() > 0 && (set_.rows * beta - limits).maxCoeff() > slack) return;
        if (std::abs(set_.contact.dot(beta) - set_.gap_sign) > slack) return;
        if (std::abs(value(beta) - value_) > same * (std::abs(value_) + 2 * set_.kernel.pattern.cells * size_ * size_))
            return;
        result_.others.push_back(beta);
    }

    void shifts() {
        const Kernel& kernel = set_.kernel;
        const int period = kernel.pattern.period_steps();
        const int free_steps = kernel.pattern.free_steps;
        const auto wave = [&](int n) { return kernel.wave(beta_, n); };
        // The amplitudes of a motion given by its waves, if its waves are those of the kernel.
        const auto take = [&](const auto& moved) {
            VectorXd beta(beta_.size());
            for (Eigen::Index j = 0; j < beta.size(); ++j)
                beta[j] = moved(kernel.class_of[static_cast<std::size_t>(j)]);
            for (int n = 0; n < period; ++n) {
                if (std::abs(moved(n) - kernel.wave(beta, n)) > same * size_) return;
            }
            add(beta);
        };
        for (int shift = 0; shift < period; ++shift) {
            stop_point();
            if (shift > 0) take([&](int n) { return wave(n + shift); });
            // Backward, from the pattern's own reversal: a wave changes its sign with the free step it arrives in.
            take([&](int n) {
                const int back = 2 * period + free_steps - 1 - n - shift;
                return back % period < free_steps ? -wave(back) : wave(back);
            });
        }
    }

    // Columns of a simplex differ in the objective only: `least_force` not at all, `nearest` by its target.
    void permutations() {
        if (objective_ != Objective::least_force && objective_ != Objective::nearest) return;
        const AdmissibleSet known = admissible_set(reduce(conditions(set_.kernel, set_.gap_sign)));
        if (known.status != AdmissibleSet::Status::nonempty || known.shape != AdmissibleSet::Shape::simplex) return;
        const Reduction& reduction = known.reduction;
        const VectorXd gamma = reduction.gamma(beta_);
        VectorXd target = VectorXd::Zero(gamma.size());
        if (objective_ == Objective::nearest)
            target = reduction.gamma(wave_basis(set_.kernel).transpose() * reference_);
        const double apart = same * std::max(target.cwiseAbs().maxCoeff(), 1e-300);

        std::vector<Eigen::Index> order(static_cast<std::size_t>(gamma.size()));
        std::iota(order.begin(), order.end(), Eigen::Index{0});
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return target[a] > target[b]; });
        std::vector<VectorXd> all{gamma};
        for (std::size_t begin = 0; begin < order.size();) {
            std::size_t end = begin + 1;
            while (end < order.size() && target[order[begin]] - target[order[end]] <= apart) ++end;
            const std::vector<Eigen::Index> group(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                                  order.begin() + static_cast<std::ptrdiff_t>(end));
            if (!permute(gamma, group, all)) {
                result_.refusal = "more than " + std::to_string(most_ties) + " optima tie";
                return;
            }
            begin = end;
        }
        for (const VectorXd& one : all) add(reduction.beta(one));
    }

    // Every point of `all` with the values of one group of columns in every order; false where they are too many.
    [[nodiscard]] bool permute(const VectorXd& gamma, const std::vector<Eigen::Index>& group,
                               std::vector<VectorXd>& all) const {
        // Values that differ by rounding are one.
        std::vector<double> values;
        std::vector<int> word;
        for (const auto j : group) {
            const auto found = std::find_if(values.begin(), values.end(),
                                            [&](double v) { return std::abs(v - gamma[j]) <= same * size_; });
            word.push_back(static_cast<int>(found - values.begin()));
            if (found == values.end()) values.push_back(gamma[j]);
        }
        std::sort(word.begin(), word.end());
        std::vector<VectorXd> permuted;
        do {
            stop_point();
            for (VectorXd one : all) {
                for (std::size_t k = 0; k < group.size(); ++k)
                    one[group[k]] = values[static_cast<std::size_t>(word[k])];
                permuted.push_back(std::move(one));
            }
            if (permuted.size() > most_ties) return false;
        } while (std::next_permutation(word.begin(), word.end()));
        all = std::move(permuted);
        return true;
    }

    const RelaxedSet& set_;
    Objective objective_;
    const VectorXd& beta_;
    const VectorXd& reference_;
    double value_;
    double size_;
    TiedOptima result_;
};

}  // namespace

std::vector<VectorXd> vertices_of_greatest_energy(const Kernel& kernel, int gap_sign) {
    const AdmissibleSet known = admissible_set(reduce(conditions(kernel, gap_sign)));
    std::vector<VectorXd> result;
    for (const VectorXd& vertex : known.vertices) {
        if (known.energy(vertex) >= known.energy(known.vertices.front()) * (1 - same))
            result.push_back(known.reduction.beta(vertex));
    }
    return result;
}

TiedOptima tied_optima(const RelaxedSet& set, Objective objective, const VectorXd& beta, const VectorXd& reference) {
    const Eigen::Index window = objective == Objective::nearest ? 2 * Eigen::Index{set.kernel.pattern.cells} : 0;
    if (beta.size() != set.dimension() || (window > 0 && reference.size() != window)) {
        throw std::invalid_argument("beta, reference: expected sizes " + std::to_string(set.dimension()) + " and " +
                                    std::to_string(window) + ", got " + std::to_string(beta.size()) + " and " +
                                    std::to_string(reference.size()));
    }
    return Ties(set, objective, beta, reference).find();
}

}  // namespace nsma
