#include "nsma/study/sensitivity/sensitivity.hpp"

#include "price/relaxed_solver.hpp"

namespace nsma {

AblationRecord ablation_record(const Kernel& kernel, int gap_sign) {
    AblationRecord record;
    record.pattern = kernel.pattern;
    record.kernel_dimension = kernel.dimension();
    record.kind = pattern_kind(kernel.pattern);
    if (kernel.dimension() == 0) return record;
    RelaxedSet set = relaxed_set(kernel, gap_sign);
    // COND1 at the ends of the flight, where COND2 has the word unless it is left out.
    set.rows.conservativeResize(set.rows.rows() + 1, Eigen::NoChange);
    set.rows.bottomRows(1) = set.contact.transpose();
    set.condition.push_back({ConditionRow::Condition::cond1, {0}});
    for (unsigned kept = 0; kept < record.survives.size(); ++kept) {
        const auto relaxation = [kept](unsigned condition) { return (kept & condition) != 0 ? 0.0 : no_bound; };
        record.survives[kept] = attainable(set, set.shift({relaxation(1), relaxation(2), relaxation(4)}));
    }
    return record;
}

}  // namespace nsma
