#include "sensitivity_folder.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "report/csv.hpp"
#include "report/one_line.hpp"
#include "report/results_folder.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr const char* pattern_columns = "cells,gap,free_steps,contact_steps";

std::string pattern_fields(const Scene& scene, const Pattern& pattern) {
    return fmt::format("{},{},{},{}", pattern.cells, scene.bar.gap, pattern.free_steps, pattern.contact_steps);
}

std::string steps_text(const std::vector<int>& steps) {
    std::string text;
    for (const int step : steps) text += fmt::format("{}{}", text.empty() ? "" : " ", step);
    return text;
}

const char* unit_name(Parameter parameter) {
    switch (parameter) {
        case Parameter::energy: return "J";
        case Parameter::cond3_row:
        case Parameter::adhesion: return "N";
        default: return "m";
    }
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

std::string price_fields(const Price& price, Objective objective, double value, int gap_sign, double level,
                         const Bar& bar) {
    const auto si = [&](const std::optional<double>& side) {
        return side ? csv_number(in_si(*side, objective, price.parameter, bar)) : std::string();
    };
    const auto relative = [&](const std::optional<double>& side) {
        return side ? csv_number(elasticity(*side, price.parameter, value, gap_sign, level)) : std::string();
    };
    const Slope& slope = price.slope;
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", name(price.parameter), unit_name(price.parameter),
                       steps_text(price.steps), price.active, kind_name(slope.kind), csv_number(slope.right),
                       csv_number(slope.left), si(slope.right), si(slope.left), relative(slope.right),
                       relative(slope.left), csv_number(slope.right_root), csv_number(slope.left_root),
                       csv_text(slope.reason));
}

double level_of(const OptimumRecord& record) { return record.level.value_or(energy_ratio(record.orbit)); }

std::string optima_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text = fmt::format(
        "{},level,energy_joule,objective,objective_value,global,nondegenerate,tied,kkt_residual,euler_defect,refusal\n",
        pattern_columns);
    for (const auto& record : records.optima) {
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", pattern_fields(scene, record.orbit.kernel.pattern),
                            csv_number(record.level), csv_number(energy(record.orbit)), name(record.objective),
                            csv_number(record.value), record.global, record.nondegenerate,
                            record.tied > 0 ? std::to_string(record.tied) : std::string(),
                            csv_number(record.kkt_residual), csv_number(record.euler_defect), csv_text(record.refusal));
    }
    return text;
}

std::string prices_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text = fmt::format("{},level,objective,objective_value,{}\n", pattern_columns, price_columns);
    for (const auto& record : records.optima) {
        for (const auto& price : record.prices) {
            text += fmt::format(
                "{},{},{},{},{}\n", pattern_fields(scene, record.orbit.kernel.pattern), csv_number(record.level),
                name(record.objective), csv_number(record.value),
                price_fields(price, record.objective, record.value, scene.bar.gap_sign(), level_of(record), scene.bar));
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
        for (const auto& derivative : record.derivatives) {
            const std::string head = fmt::format("{},{},{},{},{}", pattern_fields(scene, record.orbit.kernel.pattern),
                                                 csv_number(record.level), name(record.objective),
                                                 name(derivative.parameter), unit_name(derivative.parameter));
            if (!derivative.slope.beta) {
                text += fmt::format("{},,,,{}\n", head, csv_text(derivative.slope.reason));
                continue;
            }
            const double unit = unit_of(derivative.parameter, scene.bar);
            for (Eigen::Index j = 0; j < derivative.slope.beta->size(); ++j) {
                const double rate = (*derivative.slope.beta)[j];
                text += fmt::format("{},{},{},{},\n", head, j, csv_number(rate), csv_number(rate * velocity / unit));
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
        const auto rows = [&](const char* end, double value, const std::vector<Price>& prices) {
            for (const auto& price : prices) {
                text += fmt::format(
                    "{},{},{},{},{},{},{},{},{},{},{}\n", pattern_fields(scene, record.pattern),
                    record.mode ? fmt::format("{}", *record.mode) : "", csv_number(record.pattern.frequency_ratio()),
                    end, csv_number(value), csv_number(value * scene.bar.energy_unit()),
                    csv_number(record.frequency_by_energy), csv_number(record.frequency_by_energy_difference),
                    csv_number(record.frequency_by_gap), csv_number(record.frequency_by_gap_difference),
                    price_fields(price, Objective::min_energy, value, scene.bar.gap_sign(), value, scene.bar));
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
        const bool length = record.relaxed != "adhesion";
        const bool force = record.relaxed.find("adhesion") != std::string::npos;
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", pattern_fields(scene, record.pattern),
                            record.relaxed, csv_number(record.amount),
                            length ? csv_number(record.amount * scene.bar.displacement_unit()) : "",
                            force ? csv_number(record.amount * scene.bar.force_unit()) : "", record.admissible,
                            record.failed, csv_number(record.least), csv_number(record.greatest), record.unbounded,
                            csv_number(record.level), name(scene.objective), csv_number(record.objective));
    }
    return text;
}

std::string ablation_text(const Scene& scene, const SensitivityRecords& records) {
    std::string text =
        fmt::format("{},kernel_dimension,kernel,cond1,cond2,cond3,cond1_cond2,cond1_cond3,cond2_cond3,all,only,kind\n",
                    pattern_columns);
    for (const auto& record : records.ablations) {
        const auto& s = record.survives;
        std::string only;  // the one condition without which it would exist
        if (!s[7]) {
            const int pairs = s[6] + s[5] + s[3];
            if (pairs == 1) only = s[6] ? "cond1" : s[5] ? "cond2" : "cond3";
        }
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", pattern_fields(scene, record.pattern),
                            record.kernel_dimension, s[0], s[1], s[2], s[4], s[3], s[5], s[6], s[7], only,
                            record.kind ? name(*record.kind) : std::string_view());
    }
    return text;
}

std::string funnel_text(const SensitivityRecords& records) {
    std::string text = "first,second,third,kernel,after_first,after_second,after_third\n";
    for (const auto& funnel : funnels(records.ablations)) {
        text += fmt::format("cond{},cond{},cond{},{},{},{},{}\n", funnel.order[0], funnel.order[1], funnel.order[2],
                            funnel.left[0], funnel.left[1], funnel.left[2], funnel.left[3]);
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

double in_si(double derivative, Objective objective, Parameter parameter, const Bar& bar) {
    const double unit = objective == Objective::least_force ? bar.force_unit() : bar.energy_unit();
    return derivative * unit / unit_of(parameter, bar);
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

std::string sensitivity_text(const std::string& file, const Scene& scene, const SensitivityRecords& records,
                             const SensitivitySummary& summary) {
    const std::string head =
        fmt::format("# nsma sensitivity: {}; columns and units: data/README.md of nsma\n", one_line(scene.title));
    if (file == "optima.csv") return head + optima_text(scene, records);
    if (file == "prices.csv") return head + prices_text(scene, records);
    if (file == "orbit-derivatives.csv") return head + derivatives_text(scene, records);
    if (file == "intervals.csv") return head + intervals_text(scene, records);
    if (file == "relaxations.csv") return head + relaxations_text(scene, records);
    if (file == "ablation.csv") return head + ablation_text(scene, records);
    if (file == "funnel.csv") return head + funnel_text(records);
    if (file == "sensitivity.txt") return summary_text(summary);
    throw std::invalid_argument("file: expected a name of sensitivity_files, got " + file);
}

void write_sensitivity(const fs::path& folder, const Scene& scene, const SensitivityRecords& records,
                       const SensitivitySummary& summary) {
    for (const char* file : sensitivity_files) {
        write_whole(folder / file, sensitivity_text(file, scene, records, summary));
    }
}

}  // namespace nsma
