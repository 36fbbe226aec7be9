#include "nsma/study/sweep_work.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "nsma/study/scan.hpp"

namespace nsma {
namespace {

bool extreme(Objective objective) {
    return objective == Objective::min_energy || objective == Objective::max_energy;
}

std::size_t at(long index) { return static_cast<std::size_t>(index); }

}  // namespace

void count(SweepSummary& summary, const PatternRecord& record) {
    ++summary.patterns;
    if (!record.proved) ++summary.unproved;
    const auto& interval = record.interval;
    if (record.verdict == Verdict::admissible && record.gap_sign != 0 && !interval.unbounded &&
        interval.greatest_exact.empty()) {
        ++summary.open_bounds;
    }
    switch (record.verdict) {
        case Verdict::trivial: ++summary.trivial; break;
        case Verdict::inadmissible: ++summary.inadmissible; break;
        case Verdict::admissible: ++summary.admissible; break;
        default: ++summary.failed_patterns; break;
    }
}

void count(SweepSummary& summary, const OrbitAnswer& answer, bool asked) {
    if (asked) ++summary.levels;
    const bool solved = answer.verdict == Verdict::admissible;
    if (solved) {
        summary.worst_violation = std::max(summary.worst_violation, answer.replay->violations.worst());
    }
    if (answer.verdict == Verdict::failed) ++summary.failed;
    if (!asked) return;
    if (answer.verdict == Verdict::below) ++summary.below;
    if (answer.verdict == Verdict::above) ++summary.above;
    if (answer.verdict == Verdict::undecided) ++summary.undecided;
    if (!solved) return;
    ++summary.solved;
    if (answer.optimality && answer.optimality->global) {
        ++summary.global;
    } else {
        const bool bounded = answer.optimality && answer.optimality->lower_bound;
        summary.worst_gap = std::max(summary.worst_gap, bounded ? answer.optimality->gap : 1.0);
    }
    switch (answer.agreement) {
        case Agreement::not_needed: ++summary.closed_form; break;
        case Agreement::agree: ++summary.agreed; break;
        case Agreement::different_optimum: ++summary.disagreed; break;
        case Agreement::one_failed: ++summary.one_failed; break;
        case Agreement::both_failed: ++summary.failed; break;
        case Agreement::single: break;
    }
}

SweepWorker::SweepWorker(const Scene& scene, const OrbitSolverOptions& options)
    : scene_(scene), patterns_(patterns_of(scene)), solver_(options) {}

WorkResult SweepWorker::run(const WorkUnit& unit) {
    if (unit.pattern < 0 || at(unit.pattern) >= patterns_.size()) {
        throw std::invalid_argument("unit.pattern: expected 0.." + std::to_string(patterns_.size()) +
                                    " (excluded), got " + std::to_string(unit.pattern));
    }
    WorkResult result{unit.pattern, unit.place, std::nullopt, std::nullopt};
    if (unit.place < 0 || held_ != unit.pattern) {
        const auto begin = std::chrono::steady_clock::now();
        held_ = -1;
        problem_ = pattern_problem(patterns_[at(unit.pattern)], scene_.bar.gap_sign());
        held_ = unit.pattern;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        if (unit.place < 0) {
            result.record = pattern_record(problem_, scene_.bar.gap_sign(), elapsed.count());
            return result;
        }
    }
    OrbitRequest request;
    request.objective = scene_.objective;
    if (unit.place > 0 && !extreme(scene_.objective)) {
        request.level = scene_.levels.at(static_cast<std::size_t>(unit.place) - 1);
        if (!unit.reference.empty()) {
            const Eigen::Map<const Eigen::VectorXd> beta(unit.reference.data(),
                                                         static_cast<Eigen::Index>(unit.reference.size()));
            request.reference = reference_window(make_orbit(scene_.bar, problem_.kernel, beta));
        }
    }
    result.answer = solver_.solve(scene_.bar, problem_, request);
    return result;
}

SweepQueue::SweepQueue(const Scene& scene, Order order)
    : chained_(scene.objective == Objective::nearest),
      first_place_(extreme(scene.objective) || scene.bar.gap_sign() == 0 ? 1 : 0),
      last_place_(extreme(scene.objective) ? 1 : static_cast<int>(scene.levels.size())) {
    const auto patterns = patterns_of(scene);
    state_.assign(patterns.size(), State::undecided);
    undecided_ = total_ = static_cast<long>(patterns.size());
    order_.resize(patterns.size());
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
    if (order == Order::scene) return;
    std::vector<double> work(patterns.size());
    for (std::size_t i = 0; i < work.size(); ++i) {
        work[i] = static_cast<double>(kernel_dimension(patterns[i])) * patterns[i].period_steps();
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [&work](std::uint32_t a, std::uint32_t b) { return work[a] > work[b]; });
}

void SweepQueue::done(const WorkResult& result) {
    int worker = -1;
    std::erase_if(hands_, [&](const auto& hand) {
        const bool its = hand.second.pattern == result.pattern && hand.second.place == result.place;
        if (its) worker = hand.first;
        return its;
    });
    auto& state = state_.at(at(result.pattern));
    if (result.place < 0) {
        if (state == State::decided) return;
        state = State::decided;
        --undecided_;
        ++done_;
        if (result.record->verdict != Verdict::admissible || last_place_ < first_place_) return;
        total_ += last_place_;
        Open& open = open_[result.pattern];
        open.places.assign(static_cast<std::size_t>(last_place_ + 1 - first_place_), Place::left);
        open.holder = worker;
        return;
    }
    const auto found = open_.find(result.pattern);
    if (found == open_.end()) return;
    Open& open = found->second;
    Place& place = open.places.at(static_cast<std::size_t>(result.place - first_place_));
    if (place == Place::done) return;
    place = Place::done;
    if (result.place > 0) ++done_;
    if (chained_ && result.place > open.reference_place && result.place > 0 && result.answer->orbit) {
        const auto& beta = result.answer->orbit->beta;
        open.reference.assign(beta.data(), beta.data() + beta.size());
        open.reference_place = result.place;
    }
    if (std::all_of(open.places.begin(), open.places.end(), [](Place p) { return p == Place::done; })) {
        open_.erase(found);
    }
}

std::optional<WorkUnit> SweepQueue::take(long pattern, Open& open, int worker) {
    const auto left = std::find(open.places.begin(), open.places.end(), Place::left);
    if (left == open.places.end()) return std::nullopt;
    if (chained_ && std::find(open.places.begin(), left, Place::handed) != left) return std::nullopt;
    *left = Place::handed;
    open.holder = worker;
    WorkUnit unit{pattern, first_place_ + static_cast<int>(left - open.places.begin()), {}};
    if (chained_ && unit.place > 0) unit.reference = open.reference;
    hands_[worker] = unit;
    return unit;
}

std::optional<WorkUnit> SweepQueue::next(int worker) {
    // The pattern in hand, then one that nobody holds (of an earlier run or a lost worker).
    for (const int holder : {worker, -1}) {
        for (auto& [pattern, open] : open_) {
            if (open.holder != holder) continue;
            if (auto unit = take(pattern, open, worker)) return unit;
        }
    }
    const auto decide = [&](long pattern) {
        state_[at(pattern)] = State::handed;
        return hands_[worker] = WorkUnit{pattern, -1, {}};
    };
    if (!returned_.empty()) {
        const long pattern = returned_.back();
        returned_.pop_back();
        return decide(pattern);
    }
    for (; cursor_ < order_.size(); ++cursor_) {
        const long pattern = order_[cursor_];
        if (state_[at(pattern)] == State::undecided) return decide(pattern);
    }
    // Help with the pattern that has most left.
    Open* most = nullptr;
    long of = -1;
    long left = 0;
    for (auto& [pattern, open] : open_) {
        const auto waiting = std::count(open.places.begin(), open.places.end(), Place::left);
        if (waiting > left) {
            most = &open;
            of = pattern;
            left = waiting;
        }
    }
    if (most == nullptr) return std::nullopt;
    const int holder = most->holder;
    auto unit = take(of, *most, worker);
    // The helper goes on helping; the holder keeps its own.
    if (unit) most->holder = holder;
    return unit;
}

void SweepQueue::lost(int worker) {
    for (auto& [pattern, open] : open_) {
        if (open.holder == worker) open.holder = -1;
    }
    const auto hand = hands_.find(worker);
    if (hand == hands_.end()) return;
    const WorkUnit unit = std::move(hand->second);
    hands_.erase(hand);
    if (unit.place < 0) {
        state_[at(unit.pattern)] = State::undecided;
        returned_.push_back(unit.pattern);
        return;
    }
    const auto open = open_.find(unit.pattern);
    if (open == open_.end()) return;
    open->second.places.at(static_cast<std::size_t>(unit.place - first_place_)) = Place::left;
}

}  // namespace nsma
