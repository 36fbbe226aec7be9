#include <algorithm>
#include <cmath>
#include <tuple>

#include "accuracy_parts.hpp"
#include "finite_elements.hpp"
#include "program_methods.hpp"
#include "wave/dense_wfem.hpp"
#include "wave/wave_queue.hpp"
#include "nsma/orbit/orbit.hpp"
#include "nsma/orbit/replay.hpp"
#include "nsma/search/orbit_solver.hpp"

namespace nsma {
namespace {

constexpr int dense_limit = 80;           // cells; beyond it a dense step only costs time
constexpr double drift_work_limit = 4e9;  // multiplications of one march

// The exact orbit that every method marches: the first nonsmooth mode on N = 5 j cells.
struct Reference {
    Reference(const Bar& the_bar, int cells) : bar(the_bar), mesh{cells} {
        Pattern pattern = accuracy_pattern(2, bar.gap_sign());
        const int times = cells / pattern.cells;
        pattern = {cells, times * pattern.free_steps, times * pattern.contact_steps};
        const PatternProblem problem = pattern_problem(pattern, bar.gap_sign(), {.prove = false});
        orbit = make_orbit(bar, problem.kernel, problem.set.reduction.beta(problem.set.least));
        state = initial_state(orbit);
        tips = tip_displacement(orbit);
        contact_time = pattern.contact_steps * mesh.time_step(bar);
    }
    [[nodiscard]] const Pattern& pattern() const { return orbit.kernel.pattern; }
    // Tip displacement at a share of the period; exact, since waves are constant over a step.
    [[nodiscard]] double tip_at(double share) const {
        const double place = share * pattern().period_steps();
        const auto step = std::min(static_cast<Eigen::Index>(place), tips.size() - 2);
        return tips[step] + (place - static_cast<double>(step)) * (tips[step + 1] - tips[step]);
    }

    Bar bar;
    Mesh mesh;
    Orbit orbit;
    State state;
    Eigen::VectorXd tips;
    double contact_time = 0;
};

// Coordinates [sigma/z; v], in which the norm is that of energy.
Eigen::VectorXd scaled(const Reference& reference, const State& state) {
    Eigen::VectorXd result = state;
    result.head(reference.mesh.cells) /= reference.bar.impedance();
    return result;
}

void compare(const Reference& reference, const State& end, DriftRecord& record) {
    const Eigen::VectorXd before = scaled(reference, reference.state);
    const Eigen::VectorXd after = scaled(reference, end);
    record.periodicity_defect = (after - before).norm() / before.norm();
    record.energy_drift = std::abs(after.squaredNorm() / before.squaredNorm() - 1.0);
}

struct FiniteElementSetting {
    FiniteElementOptions options;
    const char* method;
    const char* setting;
};
std::vector<FiniteElementSetting> finite_element_settings(int elements) {
    using Scheme = FiniteElementScheme;
    // Stable below c dt/h = 0.91 at stiffness 1 and 0.42 at 10 (the tip against the wall).
    return {
        {{Scheme::central_penalty, elements, 0.9, 1.0, 0.0, 0.5}, "FE central, penalty", "c dt/h 0.9, stiffness 1"},
        {{Scheme::central_penalty, elements, 0.1, 1.0, 0.0, 0.5}, "FE central, penalty", "c dt/h 0.1, stiffness 1"},
        {{Scheme::central_penalty, elements, 0.25, 10.0, 0.0, 0.5}, "FE central, penalty", "c dt/h 0.25, stiffness 10"},
        {{Scheme::moreau_jean, elements, 1.0, 1.0, 0.0, 0.5}, "FE Moreau-Jean", "c dt/h 1, e 0"},
        {{Scheme::moreau_jean, elements, 0.25, 1.0, 0.0, 0.5}, "FE Moreau-Jean", "c dt/h 0.25, e 0"},
        {{Scheme::moreau_jean, elements, 0.25, 1.0, 1.0, 0.5}, "FE Moreau-Jean", "c dt/h 0.25, e 1"}};
}

MarchRecord measure(const Reference& reference, const FiniteElementSetting& setting, int repeats) {
    MarchRecord record;
    record.cells = setting.options.elements;
    record.method = setting.method;
    record.setting = setting.setting;
    record.decides_contact = true;
    const double duration = period(reference.orbit);
    std::vector<double> seconds;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        FiniteElementBar bar(reference.bar, reference.mesh, reference.state, duration, setting.options);
        record.steps = bar.steps();
        std::vector<double> tips(static_cast<std::size_t>(bar.steps()));
        int contact_steps = 0;
        const double begin = cpu_seconds();
        for (int n = 0; n < bar.steps(); ++n) {
            bar.step();
            tips[static_cast<std::size_t>(n)] = bar.tip();
            // The release that the orbit begins with is not part of its contact phase.
            if (bar.in_contact() && n > bar.steps() / 4) ++contact_steps;
        }
        seconds.push_back(cpu_seconds() - begin);
        record.tip_error = 0;
        for (int n = 0; n < bar.steps(); ++n) {
            const double share = static_cast<double>(n + 1) / bar.steps();
            record.tip_error =
                std::max(record.tip_error, std::abs(tips[static_cast<std::size_t>(n)] - reference.tip_at(share)));
        }
        record.tip_error /= reference.bar.displacement_unit();
        record.contact_error = std::abs(contact_steps * bar.time_step() / reference.contact_time - 1.0);
    }
    record.seconds = spread(seconds);
    return record;
}

DriftRecord drift(const Reference& reference, const FiniteElementSetting& setting, int periods) {
    DriftRecord record{reference.mesh.cells, setting.method, setting.setting, periods, 0, 0, 0};
    FiniteElementBar bar(reference.bar, reference.mesh, reference.state, period(reference.orbit), setting.options);
    const double energy = bar.energy();
    const Eigen::VectorXd displacement = bar.displacement();
    const Eigen::VectorXd velocity = bar.velocity();
    const double begin = cpu_seconds();
    const long steps = static_cast<long>(periods) * bar.steps();
    for (long n = 0; n < steps; ++n) bar.step();
    record.seconds = cpu_seconds() - begin;
    record.energy_drift = std::abs(bar.energy() / energy - 1.0);
    record.periodicity_defect =
        std::sqrt(bar.energy_of(bar.displacement() - displacement, bar.velocity() - velocity) / energy);
    return record;
}

// The wave methods; those but the queue are told the contact steps.
enum class WaveMethod { queue, cells, repeated, squared };
constexpr WaveMethod wave_methods[] = {WaveMethod::queue, WaveMethod::cells, WaveMethod::repeated, WaveMethod::squared};
const char* name(WaveMethod method) {
    switch (method) {
        case WaveMethod::queue: return "wave queue";
        case WaveMethod::cells: return "cell update";
        case WaveMethod::repeated: return "dense A^n, repeated";
        case WaveMethod::squared: return "dense A^n, squared";
    }
    return "";
}

Eigen::MatrixXd power(Eigen::MatrixXd base, long exponent) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Identity(base.rows(), base.cols());
    for (; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1) result = result * base;
        if (exponent > 1) base = base * base;
    }
    return result;
}

// March over whole periods; CPU seconds are added to `seconds`.
State advance(const Reference& reference, WaveMethod method, int periods, double& seconds) {
    const Pattern& pattern = reference.pattern();
    const auto& [bar, mesh] = std::tie(reference.bar, reference.mesh);
    State state = reference.state;
    const double begin = cpu_seconds();
    if (method == WaveMethod::queue) {
        WaveQueue queue(bar, mesh, state);
        // Contact by penetration and tension, ties within rounding of the displacements.
        const double tie = 1e-9 * bar.displacement_unit();
        bool contact = false;
        const long steps = static_cast<long>(periods) * pattern.period_steps();
        for (long n = 0; n < steps; ++n) {
            contact = contact ? queue.contact_force() <= 0 : queue.tip_after_free_step() > bar.gap + tie;
            if (contact) {
                queue.step_contact();
            } else {
                queue.step_free();
            }
        }
        state = queue.state();
    } else if (method == WaveMethod::cells) {
        for (int k = 0; k < periods; ++k) {
            for (int n = 0; n < pattern.period_steps(); ++n)
                dense::cell_step(bar, mesh, n >= pattern.free_steps, state);
        }
    } else if (method == WaveMethod::repeated) {
        const Eigen::MatrixXd flight = dense::free_step_matrix(bar, mesh);
        const Eigen::MatrixXd contact = dense::contact_step_matrix(bar, mesh);
        State next(state.size());
        for (int k = 0; k < periods; ++k) {
            for (int n = 0; n < pattern.period_steps(); ++n) {
                next.noalias() = (n < pattern.free_steps ? flight : contact) * state;
                state = next;
            }
        }
    } else {
        const Eigen::MatrixXd once = power(dense::contact_step_matrix(bar, mesh), pattern.contact_steps) *
                                     power(dense::free_step_matrix(bar, mesh), pattern.free_steps);
        state = power(once, periods) * state;
    }
    seconds += cpu_seconds() - begin;
    return state;
}

double work(WaveMethod method, int cells, int steps) {
    switch (method) {
        case WaveMethod::queue: return steps;
        case WaveMethod::cells: return 10.0 * cells * steps;
        case WaveMethod::repeated: return 4.0 * cells * cells * steps;
        case WaveMethod::squared: return 8.0 * std::pow(cells, 3) * 40;
    }
    return 0;
}

MarchRecord measure(const Reference& reference, WaveMethod method, int repeats) {
    MarchRecord record;
    record.cells = reference.mesh.cells;
    record.method = name(method);
    record.steps = reference.pattern().period_steps();
    record.decides_contact = method == WaveMethod::queue;
    std::vector<double> seconds;
    State end;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        double once = 0;
        end = advance(reference, method, 1, once);
        seconds.push_back(once);
    }
    record.seconds = spread(seconds);
    const double unit = reference.bar.displacement_unit();
    if (method == WaveMethod::queue) {
        const MarchReport report = march(reference.bar, reference.mesh, reference.state, record.steps);
        for (int n = 0; n < record.steps; ++n) {
            record.tip_error =
                std::max(record.tip_error,
                         std::abs(report.first_period[static_cast<std::size_t>(n)].tip - reference.tips[n]) / unit);
        }
        record.contact_error = std::abs(1.0 * report.contact_steps / reference.pattern().contact_steps - 1.0);
    } else {
        record.tip_error = std::abs(tip_displacement(reference.bar, reference.mesh, end) - reference.tips[0]) / unit;
    }
    return record;
}

}  // namespace

void study_marching(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    for (const int cells : run.sizes.cells) {
        if (!run.go_on()) return;
        const Reference reference(bar, cells);
        for (const WaveMethod method : wave_methods) {
            const bool is_dense = method == WaveMethod::repeated || method == WaveMethod::squared;
            if (is_dense && cells > dense_limit) continue;
            run.sink.march(measure(reference, method, run.sizes.repeats));
        }
        for (const auto& setting : finite_element_settings(cells)) {
            run.sink.march(measure(reference, setting, run.sizes.repeats));
        }
    }
    const Reference reference(bar, run.sizes.drift_cells);
    for (const int periods : run.sizes.periods) {
        const double steps = 1.0 * periods * reference.pattern().period_steps();
        for (const WaveMethod method : wave_methods) {
            if (!run.go_on()) return;
            if (work(method, reference.mesh.cells, static_cast<int>(std::min(steps, 2e9))) > drift_work_limit) continue;
            DriftRecord record{reference.mesh.cells, name(method), "", periods, 0, 0, 0};
            compare(reference, advance(reference, method, periods, record.seconds), record);
            run.sink.drift(record);
        }
        for (const auto& setting : finite_element_settings(reference.mesh.cells)) {
            if (!run.go_on()) return;
            run.sink.drift(drift(reference, setting, periods));
        }
    }
}

}  // namespace nsma
