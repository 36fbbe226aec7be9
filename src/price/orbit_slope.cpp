#include "optimum_analysis.hpp"
#include "numerics/decompositions.hpp"

namespace nsma {

// Least-norm step that the constraints ask for, then the Newton correction within their flat.
OrbitSlope OptimumAnalysis::orbit_slope(const Shift& direction) const {
    const auto refuse = [](const std::string& reason) { return OrbitSlope{std::nullopt, reason}; };
    if (!refusal.empty()) return refuse(refusal);
    if (direction.band != 0) return refuse("a band opens to one side only");
    if (place_ != Place::free && place_ != Place::inside) return refuse("the level is an end of the energy interval");
    if (!strict) return refuse("strict complementarity fails: an active row has no clearly positive multiplier");
    if (!isolated) return refuse("the optimum is not isolated");
    const Rates rate = rates(direction);
    const auto contact = equalities_.rows();
    const auto count = contact + normals_.rows() + (has_sphere_ ? 1 : 0);
    Eigen::MatrixXd rows(count, x.size());
    Eigen::VectorXd target(count);
    rows.topRows(contact) = equalities_;
    target.head(contact) = rate.equality;
    rows.middleRows(contact, normals_.rows()) = normals_;
    target.segment(contact, normals_.rows()) = rate.rows;
    if (has_sphere_) {
        rows.row(count - 1) = sphere_.transpose();
        target[count - 1] = rate.sphere;
    }
    Eigen::VectorXd step = Eigen::VectorXd::Zero(x.size());
    if (count > 0) {
        step = MinimumNorm(rows, magnitude_.positive).refined(target);
        if ((rows * step - target).norm() > magnitude_.zero * (1.0 + target.norm())) {
            return refuse("the active rows part: they are dependent and relaxed apart");
        }
    }
    bool clear = true;
    const Eigen::MatrixXd flat = orthogonal_space(rows, x.size(), magnitude_, clear);
    if (flat.cols() > 0) {
        const Eigen::MatrixXd hessian = lagrangian();
        const auto back = solve_definite(flat.transpose() * hessian * flat, flat.transpose() * (hessian * step));
        if (!back) return refuse("the optimum is not isolated");
        step -= flat * *back;
    }
    return {form.scale * step.head(form.orbit_variables), {}};
}

}  // namespace nsma
