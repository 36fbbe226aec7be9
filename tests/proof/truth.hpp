#pragma once

#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "nsma/proof/prove.hpp"

/// What is true of a pattern, and whether a certificate says only that.
namespace truth {

using nsma::Certificate;
using nsma::Integer;
using nsma::Pattern;
using nsma::Rational;

inline std::vector<Pattern> patterns(int cells) {
    std::vector<Pattern> result;
    for (int period = 2; period <= 4 * cells; ++period) {
        for (int contact = 1; contact < period; ++contact) result.push_back({cells, period - contact, contact});
    }
    return result;
}

// Under the address sanitizer the same tests look at fewer patterns.
#ifdef __SANITIZE_ADDRESS__
inline constexpr int largest_mesh = 5;
#else
inline constexpr int largest_mesh = 8;
#endif

inline std::string title(const Pattern& pattern, int gap_sign) {
    return std::string("(") + std::to_string(pattern.cells) + ", " + std::to_string(pattern.free_steps) + ", " +
           std::to_string(pattern.contact_steps) + ") gap " + std::to_string(gap_sign);
}

template <typename Visit>
void for_each_problem(int from, int to, Visit visit) {
    for (int cells = from; cells <= to; ++cells) {
        for (const Pattern& pattern : patterns(cells)) {
            for (const int gap_sign : {-1, 0, 1}) {
                SCOPED_TRACE(title(pattern, gap_sign));
                visit(pattern, gap_sign);
            }
        }
    }
}

inline nsma::Proof proof_of(const Pattern& pattern, int gap_sign) {
    const auto kernel = nsma::exact_kernel(pattern);
    return nsma::prove(kernel, nsma::admissible_set(nsma::reduce(nsma::conditions(kernel, gap_sign))));
}

/// Known facts by (N, r, p, sign d), each computed once.
class Facts {
public:
    const nsma::Proof& of(const Pattern& pattern, int gap_sign) {
        const std::tuple key{pattern.cells, pattern.free_steps, pattern.contact_steps, gap_sign};
        const auto found = known_.find(key);
        if (found != known_.end()) return found->second;
        return known_.emplace(key, proof_of(pattern, gap_sign)).first->second;
    }

    /// Empty when every statement of the certificate is true, else the first that is not.
    std::string lie(const Certificate& said) {
        using Claim = Certificate::Claim;
        const bool energies = said.energy_least || said.energy_attained || said.energy_bound;
        if (said.claim == Claim::trivial) {
            if (nsma::kernel_dimension(said.pattern) != 0) return "trivial";
            if (said.kind) return "a kind of a trivial kernel";
            return energies ? "an energy of a trivial kernel" : "";
        }
        const auto& proof = of(said.pattern, said.gap_sign);
        const auto& known = proof.certificate;
        if (!proof.verdict_proved) return "nothing known";
        if (said.claim != known.claim) return "emptiness";
        if (said.kind != known.kind) return "kind";
        if (said.claim == Claim::empty || said.gap_sign == 0) return energies ? "an energy where there is none" : "";
        if (said.energy_least != known.energy_least) return "energy_least";
        if (!proof.exact_greatest()) return "greatest energy unknown";
        const bool unbounded = !known.ray.empty();
        if (!unbounded && !said.ray.empty()) return "ray";
        if (unbounded && said.energy_bound) return "energy_bound of an unbounded set";
        if (said.energy_bound && *said.energy_bound < *known.energy_attained) return "energy_bound";
        if (said.energy_attained && *said.energy_attained < *known.energy_least) return "energy_attained";
        if (!unbounded && said.energy_attained && *said.energy_attained > *known.energy_attained)
            return "energy_attained";
        return "";
    }

private:
    std::map<std::tuple<int, int, int, int>, nsma::Proof> known_;
};

}  // namespace truth
