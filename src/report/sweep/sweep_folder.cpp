#include "sweep_folder.hpp"

#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tables.hpp"
#include "nsma/report/orbit_json.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

std::string summary_json(const SweepSummary& summary) {
    // Made as an object: the library does not survive that memory ends where it makes one of a null.
    auto json = nlohmann::ordered_json::object();
    json["patterns"] = summary.patterns;
    json["trivial"] = summary.trivial;
    json["inadmissible"] = summary.inadmissible;
    json["admissible"] = summary.admissible;
    json["kinds"] = nlohmann::ordered_json::object();
    for (const PatternKind kind : pattern_kinds)
        json["kinds"][std::string(name(kind))] = summary.kinds[static_cast<std::size_t>(kind)];
    json["left"] = summary.left;
    json["failed_patterns"] = summary.failed_patterns;
    json["levels"] = summary.levels;
    json["solved"] = summary.solved;
    json["copies"] = summary.copies;
    json["closed_form"] = summary.closed_form;
    json["below"] = summary.below;
    json["above"] = summary.above;
    json["undecided"] = summary.undecided;
    json["unproved"] = summary.unproved;
    json["open_bounds"] = summary.open_bounds;
    json["global"] = summary.global;
    json["proved_exactly"] = summary.proved_exactly;
    json["certificates"] = summary.certificates;
    json["certificate_bytes"] = summary.certificate_bytes;
    json["check_seconds"] = summary.check_seconds;
    json["worst_gap"] = summary.worst_gap;
    json["agreed"] = summary.agreed;
    json["disagreed"] = summary.disagreed;
    json["one_failed"] = summary.one_failed;
    json["failed"] = summary.failed;
    json["worst_violation"] = summary.worst_violation;  // NaN and infinity become null
    json["seconds"] = summary.seconds;
    json["interrupted"] = summary.interrupted;
    return json.dump(2);
}

}  // namespace

fs::path prepare_sweep_folder(const fs::path& folder, const Scene& scene) {
    prepare_results_folder(folder, scene, sweep_files);
    return folder;
}

void expect_sweep_folder(const fs::path& folder) {
    expect_folder(folder, "the folder of a sweep");
    std::error_code code;
    for (const char* store : {store_name, store_part_name}) {
        if (fs::exists(folder / store, code)) return;
        if (code) fail(folder / store, fmt::format("cannot be read: {}", code.message()));
    }
    fail(folder, fmt::format("expected the folder of a sweep, got one without {}", store_name));
}

SweepFolder::SweepFolder(const fs::path& folder, const Scene& scene)
    : folder_(prepare_sweep_folder(folder, scene)),
      bar_(scene.bar),
      title_(scene.title),
      patterns_(folder_ / "patterns.csv"),
      levels_(folder_ / "levels.csv"),
      orbits_(folder_ / "orbits.jsonl"),
      timings_(folder_ / "timings.csv") {
    patterns_.write(patterns_csv_header() + "\n");
    levels_.write(levels_csv_header() + "\n");
    timings_.write(timings_csv_header() + "\n");
}

void SweepFolder::pattern(const PatternRecord& record) {
    patterns_.write(patterns_csv_row(bar_, record) + "\n");
    for (const std::string& row : timings_csv_rows(record)) timings_.write(row + "\n");
}

void SweepFolder::answer(const OrbitAnswer& answer, bool only_times) {
    if (!only_times) {
        levels_.write(levels_csv_row(bar_, answer) + "\n");
        if (answer.orbit) orbits_.write(orbit_json(answer, bar_, false, -1) + "\n");
        if (answer.exact_proof) {
            if (!certificates_) certificates_.emplace(folder_ / certificates_name);
            certificates_->write(answer.exact_proof->certificate + "\n");
        }
    }
    for (const std::string& row : timings_csv_rows(answer)) timings_.write(row + "\n");
}

void SweepFolder::finish(const SweepSummary& summary) {
    PartFile text(folder_ / "summary.txt"), json(folder_ / "summary.json");
    text.write(summary_table(summary));
    json.write(summary_json(summary) + "\n");
    std::vector<PartFile*> files{&patterns_, &levels_, &orbits_, &timings_, &text, &json};
    if (certificates_) {
        files.push_back(&*certificates_);
    } else {
        std::error_code code;
        fs::remove(folder_ / certificates_name, code);  // of other results
        if (code) fail(folder_ / certificates_name, fmt::format("cannot be removed: {}", code.message()));
    }
    for (PartFile* file : files) file->close();
    for (PartFile* file : files) file->put_in_place();
    write_csv_metadata(folder_, title_);
}

}  // namespace nsma
