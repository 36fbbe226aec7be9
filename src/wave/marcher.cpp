#include "nsma/wave/marcher.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "wave_queue.hpp"

namespace nsma {

namespace {

void require(const char* name, int value) {
    if (value < 1) {
        throw std::invalid_argument(fmt::format("{}: expected at least 1, got {}", name, value));
    }
}

void require(const char* name, double tolerance) {
    if (!std::isfinite(tolerance) || tolerance < 0.0) {
        throw std::invalid_argument(fmt::format("{}: expected a finite value >= 0, got {}", name, tolerance));
    }
}

/// ||b - b0||, and the energy norm of the difference of the two states up to a constant.
double distance(const WaveQueue& queue, const std::vector<double>& initial_waves) {
    double squares = 0.0;
    for (int k = 0; k < queue.window(); ++k) {
        const double difference = queue.wave(k) - initial_waves[static_cast<std::size_t>(k)];
        squares += difference * difference;
    }
    return std::sqrt(squares);
}

/// Times contact begins in a cyclic sequence of steps; 0 if it never ceases.
int phases(const std::vector<MarchedStep>& steps) {
    int count = 0;
    bool before = steps.back().contact;
    for (const MarchedStep& step : steps) {
        count += step.contact && !before;
        before = step.contact;
    }
    return count;
}

}  // namespace

MarchReport march(const Bar& bar, const Mesh& mesh, const State& initial_state, int period_steps, int periods,
                  const MarchOptions& options) {
    require("period_steps", period_steps);
    require("periods", periods);
    require("touch_tolerance", options.touch_tolerance);
    require("silent_tolerance", options.silent_tolerance);

    WaveQueue queue(bar, mesh, initial_state);
    std::vector<double> initial_waves(static_cast<std::size_t>(queue.window()));
    double absolute_sum = 0.0;  // sum|b| and max|b| never change: a step only flips signs
    double largest_wave = 0.0;
    double squares = 0.0;
    for (int k = 0; k < queue.window(); ++k) {
        const double wave = queue.wave(k);
        initial_waves[static_cast<std::size_t>(k)] = wave;
        absolute_sum += std::abs(wave);
        largest_wave = std::max(largest_wave, std::abs(wave));
        squares += wave * wave;
    }
    const double initial_norm = std::sqrt(squares);
    const double initial_energy = queue.energy();
    const double touch = options.touch_tolerance * mesh.time_step(bar) * absolute_sum;
    const double silence = options.silent_tolerance * largest_wave;

    MarchReport report;
    report.periods = periods;
    report.first_period.reserve(static_cast<std::size_t>(period_steps));
    report.worst_penetration = std::max(0.0, queue.tip() - bar.gap);

    bool contact = false;
    for (int period = 0; period < periods; ++period) {
        for (int n = 0; n < period_steps; ++n) {
            const double tip = queue.tip();
            const double wave = queue.arriving();
            const double distance_to_wall = std::abs(tip - bar.gap);
            const double beyond = queue.tip_after_free_step() - bar.gap;
            // A push at the wall would end farther beyond the wall than it starts from it; the last
            // step to a touch ends nearer. Near the wall this tells contact from free flight with
            // the errors of the motion itself as the only tolerance.
            const bool pushes = beyond > distance_to_wall;
            const bool at_wall = distance_to_wall <= touch;
            const bool silent = at_wall && std::abs(wave) <= silence;
            if (!silent) {  // a silent step keeps the name of its phase
                if (at_wall) {
                    contact = pushes;
                } else {
                    contact = contact ? !(wave < -silence) : beyond > touch || pushes;
                }
            }
            const bool held = silent ? pushes : contact;
            const double force = contact && held ? queue.contact_force() : 0.0;
            if (contact && held) {
                report.worst_separation = std::max(report.worst_separation, distance_to_wall);
                report.worst_tension = std::max(report.worst_tension, force);
                report.largest_force = std::max(report.largest_force, std::abs(force));
            }
            if (period == 0) {
                report.first_period.push_back({tip, force, contact, silent});
                ++(contact ? report.contact_steps : report.free_steps);
            }
            if (held) {
                queue.step_contact();
            } else {
                queue.step_free();
            }
            report.worst_penetration = std::max(report.worst_penetration, queue.tip() - bar.gap);
        }
        if (initial_norm > 0.0) {
            report.periodicity_defect =
                std::max(report.periodicity_defect, distance(queue, initial_waves) / initial_norm);
        }
        if (initial_energy > 0.0) {
            report.energy_drift =
                std::max(report.energy_drift, std::abs(queue.energy() - initial_energy) / initial_energy);
        }
    }
    report.contact_phases = phases(report.first_period);
    return report;
}

}  // namespace nsma
