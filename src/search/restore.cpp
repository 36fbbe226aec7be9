#include "restore.hpp"

#include <algorithm>

namespace nsma {
namespace {

// Distance beyond a row, relative to the size of the point, that rounding explains.
constexpr double row_rounding = 1e-13;

}  // namespace

std::optional<Eigen::VectorXd> restored(const OrbitProgram& orbit_program, const AdmissibleSet& set,
                                        const LevelPoints* level, const Eigen::VectorXd& raw) {
    const auto& program = orbit_program.program;
    Eigen::VectorXd x = raw.cwiseMax(program.lower).cwiseMin(program.upper);
    Eigen::VectorXd gamma = orbit_program.gamma(x);
    const Eigen::VectorXd w = set.reduction.contact_row.cast<double>();
    const Eigen::VectorXd centre = level != nullptr ? level->centre() : set.least;
    // Onto COND2, then toward the centre until no row is crossed.
    if (w.squaredNorm() > 0) gamma += w * ((set.reduction.gap_sign - w.dot(gamma)) / w.squaredNorm());
    double blend = 0;
    const auto need = [&](double excess, double centre_slack) {
        if (excess <= 0) return;
        blend = std::max(blend, centre_slack > 0 ? excess / (excess + centre_slack) : 1.0);
    };
    const Eigen::MatrixXd rows = set.reduction.rows.cast<double>();
    const Eigen::VectorXd values = rows * gamma;
    const Eigen::VectorXd slacks = -(rows * centre);
    const double rounding = row_rounding * gamma.lpNorm<1>();
    for (Eigen::Index i = 0; i < values.size(); ++i) need(values[i] - rounding, slacks[i]);
    for (Eigen::Index j = 0; j < gamma.size(); ++j) {
        if (set.reduction.bounded[static_cast<std::size_t>(j)] != 0) need(-gamma[j], centre[j]);
    }
    if (blend > 0) gamma += std::min(blend, 1.0) * (centre - gamma);
    if (level == nullptr) return gamma;
    return level->reach(gamma);
}

}  // namespace nsma
