#include "command.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "nsma/report/scene_file.hpp"

namespace nsma::app {

Scene Arguments::scene() const {
    if (period && !(0 <= (*period)[0] && (*period)[0] <= (*period)[1])) {
        throw InputError("command line: --period: expected 0 <= LO <= HI, got " + std::to_string((*period)[0]) + " " +
                         std::to_string((*period)[1]));
    }
    Scene scene = read_scene(input);
    if (cells) scene.mesh.cells = *cells;
    if (gap) scene.bar.gap = *gap;
    if (period) scene.patterns = PeriodSelection{*period, std::nullopt};
    if (objective) scene.objective = *objective;
    if (all_kinds) scene.all_kinds = true;
    try {
        validate(scene.bar);
        validate(scene.mesh);
        if (free_steps == 0) expect_feasible(scene);
    } catch (const std::invalid_argument& error) {
        throw InputError((cells || gap || period ? "command line: " : input + ": ") + error.what());
    }
    return scene;
}

std::vector<Pattern> Arguments::patterns(const Scene& scene) const {
    if (free_steps > 0) return {{scene.mesh.cells, free_steps, contact_steps}};
    return patterns_of(scene);
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
