#include "wave_queue.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace nsma {

namespace {

/// Compensated (Kahan) sum: the tip of a long queue keeps full precision.
double sum(const std::vector<double>& values) {
    double total = 0.0;
    double lost = 0.0;
    for (const double value : values) {
        const double term = value - lost;
        const double next = total + term;
        lost = (next - total) - term;
        total = next;
    }
    return total;
}

}  // namespace

WaveQueue::WaveQueue(const Bar& bar, const Mesh& mesh, const State& state)
    : bar_(bar), mesh_(mesh), time_step_(mesh.time_step(bar)), force_per_wave_(-2.0 * bar.impedance() * bar.area) {
    validate(bar);
    validate(mesh, state);
    const int cells = mesh.cells;
    const double z = bar.impedance();
    waves_.resize(static_cast<std::size_t>(mesh.window()));
    for (int i = 1; i <= cells; ++i) {
        const double stress = state[i - 1] / z;
        const double velocity = state[cells + i - 1];
        waves_[static_cast<std::size_t>(cells - i)] = 0.5 * (velocity - stress);
        waves_[static_cast<std::size_t>(cells + i - 1)] = -0.5 * (velocity + stress);
    }
    tip_ = -time_step_ * sum(waves_);
}

void WaveQueue::step(double tip_velocity) {
    tip_ += time_step_ * tip_velocity;
    waves_[head_] -= tip_velocity;  // of a free end exactly -b_n
    advance();
}

double WaveQueue::damp(double factor) {
    // The two waves of a cell, v = b' - b'' and -sigma/z = b' + b'': the first from the head on, the second behind it.
    const double same = 0.5 * (1.0 + factor);
    const double other = 0.5 * (1.0 - factor);
    const std::size_t cells = waves_.size() / 2;
    std::size_t away = head_ + cells;
    if (away >= waves_.size()) away -= waves_.size();
    std::size_t toward = away;
    double squares = 0.0;
    for (std::size_t i = 0; i < cells; ++i) {
        toward = toward == 0 ? waves_.size() - 1 : toward - 1;
        const double first = waves_[toward];
        const double second = waves_[away];
        squares += (first - second) * (first - second);
        waves_[toward] = same * first + other * second;
        waves_[away] = other * first + same * second;
        if (++away == waves_.size()) away = 0;
    }
    return 0.5 * (1.0 - factor * factor) * bar_.density * bar_.area * mesh_.cell_length(bar_) * squares;
}

void WaveQueue::advance() {
    if (++head_ == waves_.size()) {
        head_ = 0;
        tip_ = -time_step_ * sum(waves_);
    }
}

State WaveQueue::state() const {
    std::vector<double> waves(waves_.size());
    for (int k = 0; k < window(); ++k) waves[static_cast<std::size_t>(k)] = wave(k);
    return state_of_waves(bar_, waves);
}

double WaveQueue::energy() const {
    double squares = 0.0;
    for (const double wave : waves_) {
        squares += wave * wave;
    }
    return bar_.density * bar_.area * mesh_.cell_length(bar_) * squares;
}

double WaveQueue::wave(int k) const {
    if (k < 0 || k >= window()) {
        throw std::invalid_argument(fmt::format("wave: expected 0 <= k < {}, got {}", window(), k));
    }
    const std::size_t position = head_ + static_cast<std::size_t>(k);
    return waves_[position < waves_.size() ? position : position - waves_.size()];
}

State state_of_waves(const Bar& bar, const std::vector<double>& waves) {
    const auto cells = static_cast<int>(waves.size() / 2);
    const double z = bar.impedance();
    State state(2 * cells);
    for (int i = 1; i <= cells; ++i) {
        const double toward = waves[static_cast<std::size_t>(cells - i)];
        const double away = waves[static_cast<std::size_t>(cells + i - 1)];
        state[i - 1] = -z * (toward + away);
        state[cells + i - 1] = toward - away;
    }
    return state;
}

}  // namespace nsma
