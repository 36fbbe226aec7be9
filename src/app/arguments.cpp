#include "command.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "standard_streams.hpp"

#include "nsma/report/scene_file.hpp"
#include "report/bar_text.hpp"

namespace nsma::app {

Scene Arguments::scene() const {
    if (period && !(0 <= (*period)[0] && (*period)[0] <= (*period)[1])) {
        throw InputError(
            fmt::format("command line: --period: expected 0 <= LO <= HI, got {:g} {:g}", (*period)[0], (*period)[1]));
    }
    const auto checked = [this](bool said_here, const auto& check) {
        try {
            check();
        } catch (const std::invalid_argument& error) {
            throw InputError((said_here ? "command line" : input) + ": " + error.what());
        }
    };
    Scene scene = read_scene(input);
    checked(gap.has_value(), [&] {
        Bar bar = scene.bar;
        bar.gap = gap.value_or(bar.gap);
        validate(bar);
    });
    if (cells || gap) scene = with_changes(scene, cells, gap, input);
    if (period) scene.patterns = PeriodSelection{*period, std::nullopt};
    if (objective) scene.objective = *objective;
    if (all_kinds) scene.all_kinds = true;
    checked(cells || period, [&] {
        if (free_steps == 0) expect_feasible(scene);
    });
    for (const std::string& doubt : doubts(scene)) say("{}: {}", input, doubt);
    return scene;
}

std::vector<Pattern> Arguments::patterns(const Scene& scene) const {
    if (free_steps > 0) return {{scene.mesh.cells, free_steps, contact_steps}};
    return patterns_of(scene);
}

std::optional<double> Arguments::level(const Scene& scene) const {
    if (!energy || !joules) return energy;
    return *energy / scene.bar.energy_unit();
}

void Arguments::check_energy(const Scene& scene, const std::string& objective_from) const {
    const bool closed = scene.bar.gap_sign() == 0;
    const bool extreme = is_extreme(scene.objective);
    if (extreme && energy) {
        throw InputError(fmt::format("command line: --energy: expected none with objective {}, got {}",
                                     name(scene.objective), *energy));
    }
    if (extreme && closed) {
        throw InputError(fmt::format("{}: expected one at a given energy for a closed gap, got {}", objective_from,
                                     name(scene.objective)));
    }
    if (closed && free_steps > 0 && !energy) {
        throw InputError("command line: --energy: expected joules (a closed gap has no least-energy orbit), got none");
    }
}

}  // namespace nsma::app
