#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "command.hpp"

#include "nsma/search/pattern_problem.hpp"
#include "study/forced/free_march.hpp"
#include "nsma/report/input_error.hpp"
#include "report/bar_text.hpp"
#include "report/state_file.hpp"

namespace nsma::app {
namespace {

struct Start {
    State state;
    int period_steps = 0;
    std::string name;
};

// The orbit that was named: at an energy the best of its objective, else that of least energy.
Start orbit_start(const Arguments& arguments, const Scene& scene) {
    const Pattern pattern = arguments.patterns(scene).front();
    arguments.check_energy(scene, "command line: --objective");
    OrbitRequest request;
    request.objective = scene.objective;
    request.level = arguments.level(scene);
    const PatternProblem problem = pattern_problem(pattern, scene.bar.gap_sign());
    const OrbitAnswer answer = OrbitSolver(arguments.solver).solve(scene.bar, problem, request);
    if (!answer.orbit) {
        throw InputError(
            fmt::format("command line: --free {} --contact {}: expected a pattern with an orbit there, got {}{}{}",
                        pattern.free_steps, pattern.contact_steps, name(answer.verdict),
                        answer.reason.empty() ? "" : ": ", answer.reason));
    }
    return {initial_state(*answer.orbit), pattern.period_steps(),
            fmt::format("orbit ({}, {})", pattern.free_steps, pattern.contact_steps)};
}

std::string text_of(const FlightAndContact& cycle) { return fmt::format("({}, {})", cycle.free, cycle.contact); }

}  // namespace

int run_march(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    if (arguments.state.empty() == (arguments.free_steps == 0))
        throw InputError("command line: march: expected either --state or --free and --contact, got " +
                         std::string(arguments.state.empty() ? "neither" : "both"));
    const Start start = arguments.state.empty()
                            ? orbit_start(arguments, scene)
                            : Start{read_state(arguments.state, scene.mesh), 4 * scene.mesh.cells, arguments.state};
    const State state = arguments.perturb > 0 ? perturbed(scene.bar, start.state, arguments.perturb) : start.state;
    FreeMarch march;
    try {
        march = free_march(scene.bar, scene.mesh, state, scene.damping, long{arguments.periods} * start.period_steps);
    } catch (const std::invalid_argument& error) {
        throw InputError(fmt::format("{}: {}", start.name, error.what()));
    }
    fmt::print("{}\nstart         {}{}\n", derived_text(scene), start.name,
               arguments.perturb > 0 ? fmt::format(", moved by {:g} of its norm", arguments.perturb) : "");
    fmt::print("marched       {} periods of {} steps, {}\n", arguments.periods, start.period_steps,
               scene.damping.kind == Damping::Kind::none
                   ? "no damping"
                   : fmt::format("damping {:g} ({})", scene.damping.value,
                                 scene.damping.kind == Damping::Kind::tip ? "tip" : "distributed"));
    fmt::print("energy        {} to {}; lost to damping {}, in landings {}\n", si_text(march.energy_start, "J"),
               si_text(march.energy_end, "J"), si_text(march.loss, "J"), si_text(march.landing, "J"));
    fmt::print("tip           {} to {}; peak force {}\n", si_text(march.tip_least, "m"),
               si_text(march.tip_greatest, "m"), si_text(march.peak_force, "N"));
    const auto& cycles = march.cycles;
    if (cycles.empty()) {
        fmt::print("pattern       no flight with a contact after it was seen\n");
        return exit_inadmissible;
    }
    std::size_t kept = 0;
    while (kept < cycles.size() && cycles[kept].free == cycles[0].free && cycles[kept].contact == cycles[0].contact)
        ++kept;
    fmt::print("pattern       {} flights with a contact; the first is {}, kept for {}\n", cycles.size(),
               text_of(cycles[0]),
               kept == cycles.size() ? "all" : fmt::format("{}, then {}", kept, text_of(cycles[kept])));
    if (kept < cycles.size()) {
        std::map<std::pair<int, int>, int> counts;
        for (const auto& cycle : cycles) ++counts[{cycle.free, cycle.contact}];
        std::vector<std::pair<int, std::pair<int, int>>> often;
        often.reserve(counts.size());
        for (const auto& [cycle, count] : counts) often.emplace_back(count, cycle);
        std::sort(often.rbegin(), often.rend());
        fmt::print("seen          ");
        for (std::size_t i = 0; i < std::min<std::size_t>(often.size(), 6); ++i)
            fmt::print("{}({}, {}) {} times", i > 0 ? ", " : "", often[i].second.first, often[i].second.second,
                       often[i].first);
        fmt::print("{}\n", often.size() > 6 ? fmt::format(", and {} others", often.size() - 6) : "");
    }
    return exit_done;
}

}  // namespace nsma::app
