#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "accuracy_parts.hpp"
#include "finite_elements.hpp"
#include "nsma/wave/marcher.hpp"
#include "wave/dense_wfem.hpp"
#include "nsma/orbit/orbit.hpp"
#include "nsma/numerics/interruption.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace nsma {
namespace {

constexpr int look_every = 1000;  // steps, for a signal that came

constexpr int dense_limit = 80;                    // cells; beyond it a dense step only costs time
constexpr double repeated_step_limit = 1'000'000;  // steps; beyond it repeated dense ones only cost time

// The exact orbit that every method marches.
struct Reference {
    Orbit orbit;
    State state;
    Eigen::VectorXd tips;

    [[nodiscard]] const Bar& bar() const { return orbit.bar; }
    [[nodiscard]] const Pattern& pattern() const { return orbit.kernel.pattern; }
    // Tip displacement at a share of the period; exact, since waves are constant over a step.
    [[nodiscard]] double tip_at(double share) const {
        const double place = share * pattern().period_steps();
        const auto step = std::min(static_cast<Eigen::Index>(place), tips.size() - 2);
        return tips[step] + (place - static_cast<double>(step)) * (tips[step + 1] - tips[step]);
    }
};

// The first nonsmooth mode on N = 5 j cells.
Reference reference_orbit(const Bar& bar, int cells) {
    const Pattern least = accuracy_pattern(2, bar.gap_sign());
    const int times = cells / least.cells;
    const PatternProblem problem = pattern_problem({cells, times * least.free_steps, times * least.contact_steps},
                                                   bar.gap_sign(), {.prove = false});
    const Orbit orbit = make_orbit(bar, problem.kernel, problem.set.reduction.beta(problem.set.least));
    return {orbit, initial_state(orbit), tip_displacement(orbit)};
}

// What a march over whole periods came to, in the terms of MarchRecord and DriftRecord.
struct Marched {
    double seconds = 0;
    int steps = 0;
    double tip_error = 0;
    double contact_error = 0;
    double energy_drift = 0;
    double periodicity_defect = 0;
};

struct MarchMethod {
    std::string name;
    std::string setting;
    bool decides_contact;
    std::function<Marched()> march;
};

Marched march_queue(const Reference& reference, int periods) {
    Marched marched;
    marched.steps = reference.pattern().period_steps();
    MarchReport report;
    marched.seconds = cpu_seconds_of(
        [&] { report = march(reference.bar(), reference.orbit.mesh(), reference.state, marched.steps, periods); });
    for (int n = 0; n < marched.steps; ++n) {
        const double error = std::abs(report.first_period[static_cast<std::size_t>(n)].tip - reference.tips[n]);
        marched.tip_error = std::max(marched.tip_error, error / reference.bar().displacement_unit());
    }
    marched.contact_error = std::abs(1.0 * report.contact_steps / reference.pattern().contact_steps - 1.0);
    marched.energy_drift = report.energy_drift;
    marched.periodicity_defect = report.periodicity_defect;
    return marched;
}

// Marches that are told the contact steps: the state after so many periods.
using Advance = State (*)(const Reference&, int periods);

template <typename Step>
void each_step(const Pattern& pattern, int periods, const Step& step) {
    for (int k = 0; k < periods; ++k) {
        stop_point();
        for (int n = 0; n < pattern.period_steps(); ++n) step(n >= pattern.free_steps);
    }
}

State by_cells(const Reference& reference, int periods) {
    State state = reference.state;
    each_step(reference.pattern(), periods,
              [&](bool contact) { dense::cell_step(reference.bar(), reference.orbit.mesh(), contact, state); });
    return state;
}

State by_repeated_products(const Reference& reference, int periods) {
    const Eigen::MatrixXd flight = dense::free_step_matrix(reference.bar(), reference.orbit.mesh());
    const Eigen::MatrixXd held = dense::contact_step_matrix(reference.bar(), reference.orbit.mesh());
    State state = reference.state;
    State next(state.size());
    each_step(reference.pattern(), periods, [&](bool contact) {
        next.noalias() = (contact ? held : flight) * state;
        state = next;
    });
    return state;
}

Eigen::MatrixXd power(Eigen::MatrixXd base, int exponent) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Identity(base.rows(), base.cols());
    for (; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1) result = result * base;
        if (exponent > 1) base = base * base;
    }
    return result;
}

State by_squared_products(const Reference& reference, int periods) {
    const Pattern& pattern = reference.pattern();
    const Mesh mesh = reference.orbit.mesh();
    const Eigen::MatrixXd once = power(dense::contact_step_matrix(reference.bar(), mesh), pattern.contact_steps) *
                                 power(dense::free_step_matrix(reference.bar(), mesh), pattern.free_steps);
    return power(once, periods) * reference.state;
}

Marched march_told(const Reference& reference, Advance advance, int periods) {
    Marched marched;
    marched.steps = reference.pattern().period_steps();
    State end;
    marched.seconds = cpu_seconds_of([&] { end = advance(reference, periods); });
    const double tip = tip_displacement(reference.bar(), reference.orbit.mesh(), end);
    marched.tip_error = std::abs(tip - reference.tips[0]) / reference.bar().displacement_unit();
    const auto energy_of = [&](const State& state) { return energy(reference.bar(), reference.orbit.mesh(), state); };
    marched.energy_drift = std::abs(energy_of(end) / energy_of(reference.state) - 1.0);
    marched.periodicity_defect = std::sqrt(energy_of(end - reference.state) / energy_of(reference.state));
    return marched;
}

// Tip and contact are compared over the first period.
Marched march_elements(const Reference& reference, const FiniteElementOptions& options, int periods) {
    FiniteElementBar bar(reference.bar(), reference.orbit.mesh(), reference.state, period(reference.orbit), options);
    const double energy = bar.energy();
    const Eigen::VectorXd displacement = bar.displacement();
    const Eigen::VectorXd velocity = bar.velocity();
    Marched marched;
    marched.steps = bar.steps();
    Eigen::VectorXd tips(bar.steps());
    int contact_steps = 0;
    marched.seconds = cpu_seconds_of([&] {
        for (int n = 0; n < bar.steps(); ++n) {
            bar.step();
            tips[n] = bar.tip();
            // The release that the orbit begins with is not part of its contact phase.
            if (bar.in_contact() && n > bar.steps() / 4) ++contact_steps;
        }
        const long others = (periods - 1L) * bar.steps();
        for (long n = 0; n < others; ++n) {
            if (n % look_every == 0) stop_point();
            bar.step();
        }
    });
    for (int n = 0; n < bar.steps(); ++n) {
        const double share = static_cast<double>(n + 1) / bar.steps();
        marched.tip_error = std::max(marched.tip_error, std::abs(tips[n] - reference.tip_at(share)));
    }
    marched.tip_error /= reference.bar().displacement_unit();
    const double contact_time = reference.pattern().contact_steps * reference.orbit.mesh().time_step(reference.bar());
    marched.contact_error = std::abs(contact_steps * bar.time_step() / contact_time - 1.0);
    marched.energy_drift = std::abs(bar.energy() / energy - 1.0);
    marched.periodicity_defect =
        std::sqrt(bar.energy_of(bar.displacement() - displacement, bar.velocity() - velocity) / energy);
    return marched;
}

// The methods whose march of `reference` over so many periods ends soon enough; it must outlive them.
std::vector<MarchMethod> march_methods(const Reference& reference, int periods) {
    std::vector<MarchMethod> methods{
        {"wave queue", "", true, [=, &reference] { return march_queue(reference, periods); }}};
    const auto add_told = [&](const char* name, Advance advance) {
        methods.push_back({name, "", false, [=, &reference] { return march_told(reference, advance, periods); }});
    };
    const int cells = reference.pattern().cells;
    const double steps = 1.0 * periods * reference.pattern().period_steps();
    add_told("cell update", by_cells);
    if (cells <= dense_limit && steps <= repeated_step_limit) add_told("dense A^n, repeated", by_repeated_products);
    if (cells <= dense_limit) add_told("dense A^n, squared", by_squared_products);

    const auto add_elements = [&](const std::string& name, const std::string& setting,
                                  const FiniteElementOptions& options) {
        methods.push_back(
            {name, setting, true, [=, &reference] { return march_elements(reference, options, periods); }});
    };
    // Stable below c dt/h = 0.91 at stiffness 1 and 0.42 at 10 (the tip against the wall).
    for (const auto& [courant, penalty] : {std::pair{0.9, 1.0}, {0.1, 1.0}, {0.25, 10.0}}) {
        add_elements("FE central, penalty", fmt::format("c dt/h {}, stiffness {}", courant, penalty),
                     {FiniteElementScheme::central_penalty, cells, courant, penalty});
    }
    for (const auto& [courant, restitution] : {std::pair{1.0, 0.0}, {0.25, 0.0}, {0.25, 1.0}}) {
        add_elements("FE Moreau-Jean", fmt::format("c dt/h {}, e {}", courant, restitution),
                     {FiniteElementScheme::moreau_jean, cells, courant, 1.0, restitution});
    }
    return methods;
}

}  // namespace

void study_marching(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    for (const int cells : run.sizes.cells) {
        const Reference reference = reference_orbit(bar, cells);
        for (const MarchMethod& method : march_methods(reference, 1)) {
            if (!run.go_on()) return;
            Marched marched;
            const Spread seconds = repeated(run.sizes.repeats, [&] {
                marched = method.march();
                return marched.seconds;
            });
            run.add(MarchRecord{cells, method.name, method.setting, method.decides_contact, marched.steps, seconds,
                                marched.tip_error, marched.contact_error});
        }
    }
    const Reference reference = reference_orbit(bar, run.sizes.drift_cells);
    for (const int periods : run.sizes.periods) {
        for (const MarchMethod& method : march_methods(reference, periods)) {
            if (!run.go_on()) return;
            const Marched marched = method.march();
            run.add(DriftRecord{run.sizes.drift_cells, method.name, method.setting, periods, marched.energy_drift,
                                marched.periodicity_defect, marched.seconds});
        }
    }
}

}  // namespace nsma
