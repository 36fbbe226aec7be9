#include "sensitivity_folder.hpp"

#include <type_traits>

#include <fmt/format.h>

#include "report/csv.hpp"
#include "report/csv_metadata.hpp"
#include "report/results_folder.hpp"
#include "report/study_records.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

template <class Value>
std::string field(const Value& value) {
    if constexpr (std::is_convertible_v<Value, std::string_view>) {
        return csv_text(value);
    } else if constexpr (std::is_convertible_v<Value, std::optional<double>> && !std::is_integral_v<Value>) {
        return csv_number(value);
    } else {
        return fmt::format("{}", value);
    }
}

template <class... Values>
std::string fields(const Values&... values) {
    std::string text = ((field(values) + ',') + ...);
    text.pop_back();
    return text;
}

constexpr const char* pattern_columns = "cells,gap,free_steps,contact_steps";

std::string pattern_fields(const Scene& scene, const Pattern& pattern) {
    return fields(pattern.cells, scene.bar.gap, pattern.free_steps, pattern.contact_steps);
}

std::string steps_text(const std::vector<int>& steps) {
    std::string text;
    for (const int step : steps) text += fmt::format("{}{}", text.empty() ? "" : " ", step);
    return text;
}

const char* kind_name(Slope::Kind kind) {
    switch (kind) {
        case Slope::Kind::two_sided: return "two-sided";
        case Slope::Kind::one_sided: return "one-sided";
        default: return "refused";
    }
}

// parameter,steps,active,kind, both sides nondimensional, in SI and as elasticities, roots, reason
constexpr const char* price_columns =
    "parameter,parameter_unit,steps,active,kind,right,left,right_si,left_si,elasticity_right,elasticity_left,"
    "root_right,root_left,reason";

std::string price_fields(const Price& price, Objective objective, double value, double level, const Bar& bar) {
    using Number = std::optional<double>;
    const auto si = [&](const Number& side) {
        return side ? Number(in_si(*side, objective, price.parameter, bar)) : Number();
    };
    const auto relative = [&](const Number& side) {
        return side ? Number(elasticity(*side, price.parameter, value, bar.gap_sign(), level)) : Number();
    };
    const Slope& slope = price.slope;
    return fields(name(price.parameter), unit_name(price.parameter), steps_text(price.steps), price.active,
                  kind_name(slope.kind), slope.right, slope.left, si(slope.right), si(slope.left),
                  relative(slope.right), relative(slope.left), slope.right_root, slope.left_root, slope.reason);
}

std::string optima_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text = fmt::format(
        "{},level,energy_joule,objective,objective_value,global,nondegenerate,tied,kkt_residual,euler_defect,refusal\n",
        pattern_columns);
    for (const auto& record : records.optima) {
        const std::string tied = record.tied > 0 ? std::to_string(record.tied) : std::string();
        text += pattern_fields(scene, record.orbit.kernel.pattern) + ',' +
                fields(record.level, energy(record.orbit), name(record.objective), record.value, record.global,
                       record.nondegenerate, tied, record.kkt_residual, record.euler_defect, record.refusal) +
                '\n';
    }
    return text;
}

std::string prices_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text = fmt::format("{},level,objective,objective_value,{}\n", pattern_columns, price_columns);
    for (const auto& record : records.optima) {
        const double level = record.level.value_or(energy_ratio(record.orbit));
        for (const auto& price : record.prices) {
            text += pattern_fields(scene, record.orbit.kernel.pattern) + ',' +
                    fields(record.level, name(record.objective), record.value) + ',' +
                    price_fields(price, record.objective, record.value, level, scene.bar) + '\n';
        }
    }
    return text;
}

std::string derivatives_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text =
        fmt::format("{},level,objective,parameter,parameter_unit,column,dbeta,dalpha_si,reason\n", pattern_columns);
    for (const auto& record : records.optima) {
        // alpha = beta u/dt, the gap being moved at a fixed unit u.
        const double velocity = scene.bar.displacement_unit() / record.orbit.mesh().time_step(scene.bar);
        for (const auto& [parameter, slope] : record.derivatives) {
            const std::string head =
                pattern_fields(scene, record.orbit.kernel.pattern) + ',' +
                fields(record.level, name(record.objective), name(parameter), unit_name(parameter));
            if (!slope.beta) text += head + ",,,," + field(slope.reason) + '\n';
            const double unit = unit_of(parameter, scene.bar);
            for (Eigen::Index j = 0; slope.beta && j < slope.beta->size(); ++j) {
                const double rate = (*slope.beta)[j];
                text += head + ',' + fields(j, rate, rate * velocity / unit) + ",\n";
            }
        }
    }
    return text;
}

std::string intervals_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text = fmt::format(
        "{},mode,frequency_ratio,end,energy_ratio,energy_joule,frequency_by_energy,frequency_by_energy_difference,"
        "frequency_by_gap,frequency_by_gap_difference,{}\n",
        pattern_columns, price_columns);
    for (const auto& record : records.intervals) {
        const std::string mode = record.mode ? std::to_string(*record.mode) : std::string();
        const auto rows = [&](const char* end, double value, const std::vector<Price>& prices) {
            for (const auto& price : prices) {
                text += pattern_fields(scene, record.pattern) + ',' +
                        fields(mode, record.pattern.frequency_ratio(), end, value, value * scene.bar.energy_unit(),
                               record.frequency_by_energy, record.frequency_by_energy_difference,
                               record.frequency_by_gap, record.frequency_by_gap_difference) +
                        ',' + price_fields(price, Objective::min_energy, value, value, scene.bar) + '\n';
            }
        };
        rows("least", record.least, record.least_prices);
        if (record.greatest) rows("greatest", *record.greatest, record.greatest_prices);
    }
    return text;
}

std::string relaxations_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text = fmt::format(
        "{},relaxed,amount,amount_m,amount_n,admissible,failed,energy_ratio_min,energy_ratio_max,energy_unbounded,"
        "level,objective,objective_value\n",
        pattern_columns);
    for (const auto& record : records.curves) {
        std::optional<double> length, force;
        if (record.relaxed != "adhesion") length = record.amount * scene.bar.displacement_unit();
        if (record.relaxed.find("adhesion") != std::string::npos) force = record.amount * scene.bar.force_unit();
        text += pattern_fields(scene, record.pattern) + ',' +
                fields(record.relaxed, record.amount, length, force, record.admissible, record.failed, record.least,
                       record.greatest, record.unbounded, record.level, name(scene.objective), record.objective) +
                '\n';
    }
    return text;
}

std::string ablation_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text =
        fmt::format("{},kernel_dimension,kernel,cond1,cond2,cond3,cond1_cond2,cond1_cond3,cond2_cond3,all,only,kind\n",
                    pattern_columns);
    for (const auto& record : records.ablations) {
        const auto& s = record.survives;
        const char* only = "";  // the one condition without which it would exist
        if (!s[7] && s[6] + s[5] + s[3] == 1) only = s[6] ? "cond1" : s[5] ? "cond2" : "cond3";
        text += pattern_fields(scene, record.pattern) + ',' +
                fields(record.kernel_dimension, s[0], s[1], s[2], s[4], s[3], s[5], s[6], s[7], only,
                       record.kind ? name(*record.kind) : std::string_view()) +
                '\n';
    }
    return text;
}

std::string funnel_text(const SensitivityRecords& records) {
    std::string text = "first,second,third,kernel,after_first,after_second,after_third\n";
    for (const auto& [order, left] : funnels(records.ablations)) {
        text += fmt::format("cond{},{}\n", fmt::join(order, ",cond"), fmt::join(left, ","));
    }
    return text;
}

std::string summary_text(const SensitivitySummary& summary) {
    return fmt::format(
        "patterns {}, admissible {}, of which {} are no contact motion and were left\noptima {}: {} nondegenerate, {} "
        "tied with others, {} refused\n"
        "worst KKT residual {:.1e}, worst defect of Euler's identity {:.1e} (relative)\n"
        "frequency along a mode, exact against stored neighbours: worst {:.1e} (relative)\n{}",
        summary.patterns, summary.admissible, summary.left, summary.optima, summary.nondegenerate, summary.tied,
        summary.refused, summary.worst_kkt, summary.worst_euler, summary.worst_frequency,
        summary.interrupted ? "interrupted: partial results\n" : "");
}

}  // namespace

const char* unit_name(Parameter parameter) {
    switch (parameter) {
        case Parameter::energy: return "J";
        case Parameter::cond3_row:
        case Parameter::adhesion: return "N";
        default: return "m";
    }
}

std::pair<double, const char*> objective_unit(Objective objective, const Bar& bar) {
    if (objective == Objective::least_force) return {bar.force_unit(), "N"};
    return {bar.energy_unit(), "J"};
}

double in_si(double derivative, Objective objective, Parameter parameter, const Bar& bar) {
    return derivative * objective_unit(objective, bar).first / unit_of(parameter, bar);
}

double elasticity(double derivative, Parameter parameter, double value, int gap_sign, double level) {
    switch (parameter) {
        case Parameter::gap: return derivative * (gap_sign == 0 ? 1.0 : gap_sign) / value;
        case Parameter::energy: return derivative * level / value;
        default: return derivative / value;
    }
}

std::vector<Funnel> funnels(const std::vector<AblationRecord>& records) {
    std::array<int, 8> count{};
    for (const auto& record : records) {
        for (std::size_t kept = 0; kept < 8; ++kept) count[kept] += record.survives[kept] ? 1 : 0;
    }
    std::vector<Funnel> result;
    std::array<int, 3> order{1, 2, 3};
    do {
        Funnel funnel{order, {count[0], 0, 0, 0}};
        std::size_t kept = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            kept |= std::size_t{1} << (order[i] - 1);
            funnel.left[i + 1] = count[kept];
        }
        result.push_back(funnel);
    } while (std::next_permutation(order.begin(), order.end()));
    return result;
}

void open_sensitivity_folder(const fs::path& folder, const Scene& scene) {
    prepare_results_folder(folder, scene, sensitivity_files);
}

std::string sensitivity_text(const std::string& file, const Scene& scene, const SensitivityRecords& records) {
    if (file == "optima.csv") return optima_text(scene, records);
    if (file == "prices.csv") return prices_text(scene, records);
    if (file == "orbit-derivatives.csv") return derivatives_text(scene, records);
    if (file == "intervals.csv") return intervals_text(scene, records);
    if (file == "relaxations.csv") return relaxations_text(scene, records);
    if (file == "ablation.csv") return ablation_text(scene, records);
    if (file == "funnel.csv") return funnel_text(records);
    if (file == "sensitivity.txt") return summary_text(records.summary);
    throw std::invalid_argument("file: expected a name of sensitivity_files, got " + file);
}

void write_sensitivity(const fs::path& folder, const Scene& scene, const SensitivityRecords& records) {
    for (const char* file : sensitivity_files) {
        write_whole(folder / file, sensitivity_text(file, scene, records));
    }
    write_csv_metadata(folder, scene.title);
    write_records(folder, scene, records);
}

}  // namespace nsma
