#include "forced_folder.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "wave/driven_bar.hpp"
#include "nsma/report/input_error.hpp"
#include "report/csv.hpp"
#include "report/csv_metadata.hpp"
#include "report/input_file.hpp"

namespace nsma {

// Of the records: numbers as they are.
void to_json(nlohmann::json& json, ForcedKind kind) { json = name(kind); }
void from_json(const nlohmann::json& json, ForcedKind& kind) {
    const auto* found =
        std::find_if(forced_kinds.begin(), forced_kinds.end(), [&](ForcedKind one) { return json == name(one); });
    if (found == forced_kinds.end()) throw std::invalid_argument("kind");
    kind = *found;
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ForcedPoint, up, place, frequency, kind, periods, defect, divergence, energy_mean,
                                   energy_max, tip_least, tip_greatest, peak_force, work, loss, landing, balance,
                                   growth, contact_phases, section, waves, phase)

namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_record = 256U << 20U;
const std::string part_suffix = ".part";

std::string line_of(const ForcedPoint& point) { return nlohmann::json(point).dump() + "\n"; }

// A point of this scene. Throws where it is none.
ForcedPoint point_in(const std::string& line, const Scene& scene) {
    auto point = nlohmann::json::parse(line).get<ForcedPoint>();
    const auto& frequencies = scene.forcing.value().frequencies;
    const bool known = point.place >= 0 && static_cast<std::size_t>(point.place) < frequencies.size() &&
                       point.frequency == frequencies[static_cast<std::size_t>(point.place)] &&
                       point.waves.size() == static_cast<std::size_t>(scene.mesh.window()) && point.periods >= 0 &&
                       !point.section.empty();
    const auto finite = [](double value) { return std::isfinite(value); };
    if (!known || !std::all_of(point.waves.begin(), point.waves.end(), finite) ||
        !(point.phase >= 0 && point.phase < 1))
        throw std::invalid_argument("point");
    (void)DrivenBar(scene.bar, scene.mesh, state_of_waves(scene.bar, point.waves), scene.damping);  // throws
    return point;
}

// `torn`: the last line may lack its end.
std::vector<ForcedPoint> points_in(const fs::path& file, const Scene& scene, bool torn, std::uintmax_t& taken) {
    std::vector<ForcedPoint> points;
    InputFile input(file, "the points of a forced response");
    const std::uintmax_t size = fs::file_size(file);
    taken = 0;
    for (std::string line; input.line(line, longest_record); taken += line.size() + 1) {
        if (torn && taken + line.size() == size) break;
        try {
            points.push_back(point_in(line, scene));
        } catch (const std::exception&) {
            fail(file, fmt::format("is damaged: line {}: expected a point of this scene, got something else",
                                   input.line_number()));
        }
    }
    return points;
}

std::string response_text(const Scene& scene, const std::vector<ForcedPoint>& points) {
    std::string text =
        "direction,frequency_ratio,frequency_hz,kind,periods,defect,divergence,energy_mean_joule,energy_max_joule,"
        "energy_ratio_max,tip_min_m,tip_max_m,peak_force_n,contact_phases,work_joule,loss_joule,landing_joule,growth_"
        "joule,"
        "balance\n";
    const double joule = scene.bar.energy_unit();
    const double hertz = 0.25 / scene.bar.travel_time();
    for (const ForcedPoint& point : points) {
        text += fmt::format("{},{},{},{},{}", point.up ? "up" : "down", csv_number(point.frequency),
                            csv_number(point.frequency * hertz), name(point.kind),
                            point.periods > 0 ? std::to_string(point.periods) : std::string());
        const std::optional<double> ratio = scene.bar.gap == 0 ? std::nullopt : std::optional(point.energy_max);
        text +=
            fmt::format(",{},{},{},{},{}", csv_number(point.defect), csv_number(point.divergence),
                        csv_number(point.energy_mean * joule), csv_number(point.energy_max * joule), csv_number(ratio));
        for (const double value :
             {point.tip_least, point.tip_greatest, point.peak_force, point.contact_phases, point.work * joule,
              point.loss * joule, point.landing * joule, point.growth * joule, point.balance})
            text += ',' + csv_number(value);
        text += '\n';
    }
    return text;
}

std::string balance_text(const Scene& scene) {
    std::string text = "mode,frequency_ratio,frequency_hz,energy_ratio,energy_joule,work_over_loss\n";
    for (const BalancePoint& point : balance_points(scene)) {
        text += fmt::format("{},{},{},{},{},{}\n", point.mode, csv_number(point.frequency),
                            csv_number(point.frequency * 0.25 / scene.bar.travel_time()), csv_number(point.energy),
                            csv_number(point.energy * scene.bar.energy_unit()), csv_number(point.ratio));
    }
    return text;
}

}  // namespace

ForcedFolder::ForcedFolder(const fs::path& folder, const Scene& scene, bool resume)
    : folder_(folder),
      scene_(scene),
      part_((prepare_results_folder(folder, scene, forced_files), folder / forced_records_name), PartFile::Old::kept) {
    std::uintmax_t taken = 0;
    if (resume) known_ = points_in((folder / forced_records_name).string() + part_suffix, scene, true, taken);
    part_.cut(taken);
}

void ForcedFolder::add(const ForcedPoint& point) { part_.write(line_of(point)); }

void ForcedFolder::finish(const std::vector<ForcedPoint>& points) {
    // In the order of the sweeps, whoever was first; until they are all there what was kept stays.
    std::string text;
    for (const ForcedPoint& point : points) text += line_of(point);
    const fs::path ordered = folder_ / (std::string(forced_records_name) + ".ordered");
    write_whole(ordered, text);
    std::error_code code;
    fs::rename(ordered, folder_ / forced_records_name, code);
    if (!code) fs::remove((folder_ / forced_records_name).string() + part_suffix, code);
    if (code) fail(folder_ / forced_records_name, fmt::format("cannot be written: {}", code.message()));
    write_forced(folder_, scene_, points);
}

std::vector<ForcedPoint> read_forced(const fs::path& folder, const Scene& scene) {
    std::uintmax_t taken = 0;
    if (!scene.forcing) fail(folder / "scene.toml", "expected a table [forcing], got none");
    return points_in(folder / forced_records_name, scene, false, taken);
}

void write_forced(const fs::path& folder, const Scene& scene, const std::vector<ForcedPoint>& points) {
    write_whole(folder / forced_files[0], response_text(scene, points));
    write_whole(folder / forced_files[1], balance_text(scene));
    write_whole(folder / forced_files[2], forced_text(scene, points));
    write_csv_metadata(folder, scene.title);
}

std::string forced_text(const Scene& scene, const std::vector<ForcedPoint>& points) {
    std::string text;
    const auto row = [&text](std::string_view what, std::string_view value) {
        text += fmt::format("{:<38}{:>10}\n", what, value);
    };
    row("frequencies", fmt::format("{}", points.size()));
    double balance = 0;
    for (const ForcedPoint& point : points) balance = std::max(balance, point.balance);
    for (const ForcedKind kind : forced_kinds) {
        const auto count = std::count_if(points.begin(), points.end(),
                                         [kind](const ForcedPoint& point) { return point.kind == kind; });
        row(fmt::format("  {}", name(kind)), fmt::format("{}", count));
    }
    row("energy not accounted for, over work", fmt::format("{:.1e}", balance));
    double work = 0, landing = 0;
    for (const ForcedPoint& point : points) {
        if (point.peak_force == 0) continue;
        work += std::abs(point.work);
        landing += point.landing;
    }
    if (work > 0) row("lost in landings, over work [%]", fmt::format("{:.1f}", 100 * landing / work));
    if (landing > 0.05 * work)
        text +=
            "landings within a step take more than 5 % of the work, of the mesh and not of the bar: more cells, in "
            "proportion less\n";
    const double hertz = 0.25 / scene.bar.travel_time();
    for (const Jump& jump : jumps(points)) {
        text +=
            fmt::format("sweeping {} the response jumps {} between {:.5g} and {:.5g} omega_1 ({:.5g} and {:.5g} Hz)\n",
                        jump.up ? "up" : "down", jump.rises ? "up" : "down", jump.from, jump.to, jump.from * hertz,
                        jump.to * hertz);
    }
    for (const BalancePoint& point : predicted_jumps(balance_points(scene))) {
        text += fmt::format(
            "mode {} alone predicts that it ends at {:.5g} omega_1 ({:.5g} Hz): the force can do no more work than "
            "the damping takes\n",
            point.mode, point.frequency, point.frequency * hertz);
    }
    return text;
}

}  // namespace nsma
