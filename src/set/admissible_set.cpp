#include "nsma/set/admissible_set.hpp"

#include <algorithm>

#include "known_set.hpp"

namespace nsma {

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
    if (!data.empty_because.empty()) {
        set.status = AdmissibleSet::Status::empty;
        set.reason = data.empty_because;
        return set;
    }
    set.flat_dimension = data.variables() - (data.contact_row.isZero() ? 0 : 1);
    set.shape = shape_of(data);
    if (set.shape == AdmissibleSet::Shape::none) {
        set.reason = "COND1-3 leave neither a simplex nor a chain";
        return set;
    }
    decide_in_closed_form(set);
    return set;
}

}  // namespace nsma
