#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "nsma/orbit/pattern.hpp"

namespace nsma {

/// Exact kernel of S_T in wave form. Q0 is in ker S_T if and only if b has period n_T; the map
/// n -> n + 2N (mod n_T) splits the steps into g = gcd(2N, n_T) classes n mod g, and each class
/// whose signs close up carries one free amplitude: b_n = eps_n alpha_{class(n)}.
/// Source: [1] Eq. (4)-(5), solved by cycles.
struct Kernel {
    Pattern pattern;                ///< whose period n_T the waves have
    int classes = 0;                ///< g
    std::vector<std::int8_t> sign;  ///< eps_n in {+1, -1, 0}, n = 0..n_T-1
    std::vector<int> amplitude_of;  ///< class -> column of alpha, -1 for a dead class; size g
    std::vector<int> class_of;      ///< column of alpha -> class; size m, increasing

    [[nodiscard]] int dimension() const { return static_cast<int>(class_of.size()); }  ///< m
    /// Column of alpha that step n carries, or -1; n in [0, n_T).
    [[nodiscard]] int column(int n) const { return amplitude_of[static_cast<std::size_t>(n % classes)]; }
    /// Calls visit(n, column, eps_n) for every step of [begin, end) that carries a wave, in their order.
    template <class Visit>
    void for_each_live(int begin, int end, Visit visit) const {
        int of_class = begin % classes;
        for (int n = begin; n < end; ++n) {
            const int j = amplitude_of[static_cast<std::size_t>(of_class)];
            if (j >= 0) visit(n, static_cast<std::size_t>(j), static_cast<int>(sign[static_cast<std::size_t>(n)]));
            if (++of_class == classes) of_class = 0;
        }
    }
    /// b_n of the motion with these amplitudes (size m), in their unit; any n >= 0.
    [[nodiscard]] double wave(const Eigen::VectorXd& amplitudes, int n) const {
        const int step = n % pattern.period_steps();
        const int j = column(step);
        return j < 0 ? 0.0 : sign[static_cast<std::size_t>(step)] * amplitudes[j];
    }
    /// b_n over one period, size n_T.
    [[nodiscard]] Eigen::VectorXd waves(const Eigen::VectorXd& amplitudes) const;
};

/// Walks the g cycles, O(n_T). The sign at the smallest step of each live class is +1.
[[nodiscard]] Kernel exact_kernel(const Pattern& pattern);

/// The 2N x m matrix that maps alpha to b_0..b_{2N-1}. Columns are orthogonal with squared norm
/// 2N/g.
[[nodiscard]] Eigen::MatrixXd wave_basis(const Kernel& kernel);

}  // namespace nsma
