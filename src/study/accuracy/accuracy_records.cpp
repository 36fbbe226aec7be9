#include "accuracy_records.hpp"

#include <tuple>

namespace nsma {

std::string_view name(Outcome outcome) {
    static constexpr std::array<std::string_view, outcome_count> names{
        "success", "worse", "off-level", "outside", "other-motion", "not-finite", "limit"};
    return names.at(static_cast<std::size_t>(outcome));
}

std::string_view description(Outcome outcome) {
    static constexpr std::array<std::string_view, outcome_count> lines{
        "replayed within 1e-9 and within 1e-6 of the best objective",
        "replayed within 1e-9, but a worse orbit: a local optimum or an early stop",
        "replay refuses: the energy is not the level asked",
        "replay refuses: COND1, COND2 or COND3 is violated",
        "replay refuses: the marcher sees contact at other steps",
        "no point came back, or one with NaN",
        "stopped by its limit of time or evaluations before its point was good"};
    return lines.at(static_cast<std::size_t>(outcome));
}

void AccuracyResults::add(const AccuracyRecord& record) {
    const auto lists = std::tie(programs, kernels, marches, drifts, stability, tolerances);
    std::visit([&](const auto& one) { std::get<std::vector<std::decay_t<decltype(one)>>&>(lists).push_back(one); },
               record);
}

}  // namespace nsma
