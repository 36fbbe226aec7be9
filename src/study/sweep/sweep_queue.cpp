#include "sweep_queue.hpp"

#include <algorithm>
#include <numeric>

namespace nsma {
namespace {

// The first level of a strand starts cold: one in eight. Longer strands would save little more.
constexpr int warm_strand = 8;
// Verdicts in one message: about a millisecond of them, several times what rank 0 needs to hand them out and to store
// them. A verdict takes some 50 us, and more with m n_T.
constexpr double batch_work = 20'000;
constexpr double verdict_work = 1'000;

std::size_t at(long index) { return static_cast<std::size_t>(index); }

}  // namespace

SweepQueue::SweepQueue(const Scene& scene, const OrbitSolverOptions& options, Order order)
    : options_(options),
      all_kinds_(scene.all_kinds),
      nearest_(scene.objective == Objective::nearest),
      first_place_(is_extreme(scene.objective) || scene.bar.gap_sign() == 0 ? 1 : 0),
      last_place_(is_extreme(scene.objective) ? 1 : static_cast<int>(scene.levels.size())) {
    const auto patterns = patterns_of(scene);
    state_.assign(patterns.size(), State::left);
    undecided_ = total_ = static_cast<long>(patterns.size());
    order_.resize(patterns.size());
    std::iota(order_.begin(), order_.end(), 0U);
    const auto work = [&patterns](std::uint32_t i) {
        return static_cast<double>(kernel_dimension(patterns[i])) * patterns[i].period_steps();
    };
    if (order == Order::longest_first) {
        std::vector<double> works(order_.size());
        std::transform(order_.begin(), order_.end(), works.begin(), work);
        std::stable_sort(order_.begin(), order_.end(), [&works](auto a, auto b) { return works[a] > works[b]; });
    }
    double total = 0;
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        total += verdict_work + work(order_[i]);
        if (order == Order::longest_first && total < batch_work && i + 1 < order_.size()) continue;
        batches_.push_back(i + 1);
        total = 0;
    }
}

// The least-energy orbit is a strand by itself.
int SweepQueue::strand_of(const Open& open, int place) const {
    return place == 0 ? 0 : 1 - first_place_ + (place - 1) / open.strand_length;
}

int SweepQueue::first_place_of(const Open& open, int strand) const {
    const int level_strand = strand - (1 - first_place_);
    return level_strand < 0 ? 0 : 1 + level_strand * open.strand_length;
}

int SweepQueue::end_place_of(const Open& open, int strand) const {
    return std::min(first_place_of(open, strand + 1), last_place_ + 1);
}

SweepQueue::State& SweepQueue::state_at(Open& open, int place) const {
    return open.places.at(static_cast<std::size_t>(place - first_place_));
}

SweepQueue::Strand& SweepQueue::begin(Open& open, int strand) const {
    const auto [found, is_new] = open.begun.try_emplace(strand);
    if (is_new) found->second.next = first_place_of(open, strand);
    return found->second;
}

void SweepQueue::sit(int worker, Seat seat) {
    leave(worker);
    seats_[worker] = seat;
    const auto open = open_.find(seat.pattern);
    if (open == open_.end()) return;
    ++open->second.workers;
    unheld_.erase(seat.pattern);
}

void SweepQueue::leave(int worker) {
    const auto seat = seats_.find(worker);
    if (seat == seats_.end()) return;
    const auto open = open_.find(seat->second.pattern);
    if (open != open_.end() && --open->second.workers == 0) unheld_.insert(open->first);
    seats_.erase(seat);
}

void SweepQueue::decided(const WorkResult& result) {
    State& state = state_.at(at(result.pattern));
    if (state == State::done) return;
    state = State::done;
    --undecided_;
    ++done_;
    if (!is_solved(all_kinds_, result.record->kind) || last_place_ < first_place_) return;
    total_ += last_place_;
    Open& open = open_[result.pattern];
    open.left = last_place_ + 1 - first_place_;
    open.places.assign(at(open.left), State::left);
    if (nearest_) {
        open.strand_length = std::max(last_place_, 1);
    } else if (ipopt_is_usual(options_)) {
        open.strand_length = warm_strand;
    }
    open.available = strands(open);
    open.workers = static_cast<int>(std::count_if(
        seats_.begin(), seats_.end(), [&](const auto& seat) { return seat.second.pattern == result.pattern; }));
    if (open.workers == 0) unheld_.insert(result.pattern);
}

void SweepQueue::done(const WorkResult& result) {
    if (result.place < 0) return decided(result);
    const auto found = open_.find(result.pattern);
    if (found == open_.end()) return;
    Open& open = found->second;
    State& state = state_at(open, result.place);
    if (state == State::done) return;
    const bool handed = state == State::handed;
    state = State::done;
    if (result.place > 0) ++done_;
    if (--open.left == 0) {
        unheld_.erase(result.pattern);
        open_.erase(found);
        return;
    }
    const int number = strand_of(open, result.place);
    Strand& strand = begin(open, number);
    const int end = end_place_of(open, number);
    while (strand.next < end && state_at(open, strand.next) == State::done) ++strand.next;
    const bool finished = strand.next == end;
    if (handed && !finished) ++open.available;
    if (!handed && finished) --open.available;
    if (finished) {
        open.begun.erase(number);
        open.waiting.erase(number);
        return;
    }
    if (result.answer->orbit && result.place < strand.next) {
        strand.before.assign(result.answer->orbit->beta.begin(), result.answer->orbit->beta.end());
    }
    open.waiting.insert(number);
}

std::optional<WorkUnit> SweepQueue::take(long pattern, int worker) {
    Open& open = open_.at(pattern);
    if (open.available == 0) return std::nullopt;
    int number = -1;
    if (!open.waiting.empty()) {
        // Its own strand before another.
        const auto seat = seats_.find(worker);
        const bool own = seat != seats_.end() && seat->second.pattern == pattern && seat->second.place >= 0;
        const auto first = own ? open.waiting.find(strand_of(open, seat->second.place)) : open.waiting.end();
        number = first != open.waiting.end() ? *first : *open.waiting.begin();
        open.waiting.erase(number);
    } else {
        const auto passed = [&](int strand) {
            return state_at(open, first_place_of(open, strand)) != State::left || open.begun.contains(strand);
        };
        while (passed(open.fresh)) ++open.fresh;
        number = open.fresh++;
    }
    const Strand& strand = begin(open, number);
    --open.available;
    state_at(open, strand.next) = State::handed;
    WorkUnit unit{pattern, strand.next, strand.before};
    sit(worker, {pattern, unit.place, {}});
    return unit;
}

std::vector<WorkUnit> SweepQueue::decide(int worker) {
    std::vector<long> patterns;
    const auto add = [&](long pattern) {
        if (state_[at(pattern)] == State::left) patterns.push_back(pattern);
    };
    while (patterns.empty() && !returned_.empty()) {
        add(returned_.back());
        returned_.pop_back();
    }
    for (; patterns.empty() && batch_ < batches_.size(); ++batch_) {
        for (std::uint32_t i = batch_ > 0 ? batches_[batch_ - 1] : 0; i < batches_[batch_]; ++i) add(order_[i]);
    }
    std::vector<WorkUnit> units;
    for (const long pattern : patterns) {
        state_[at(pattern)] = State::handed;
        units.push_back({pattern, -1, {}});
    }
    if (!patterns.empty()) sit(worker, {patterns.back(), -1, patterns});  // the last one's problem is at hand then
    return units;
}

// With the pattern that has most strands left.
std::optional<WorkUnit> SweepQueue::help(int worker) {
    const auto most = std::max_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
        return a.second.available < b.second.available;
    });
    return most == open_.end() ? std::nullopt : take(most->first, worker);
}

std::vector<WorkUnit> SweepQueue::next(int worker) {
    const auto seat = seats_.find(worker);
    if (seat != seats_.end() && open_.contains(seat->second.pattern)) {
        if (auto unit = take(seat->second.pattern, worker)) return {std::move(*unit)};
    }
    if (!unheld_.empty()) {
        if (auto unit = take(*unheld_.begin(), worker)) return {std::move(*unit)};
    }
    if (auto units = decide(worker); !units.empty()) return units;
    if (auto unit = help(worker)) return {std::move(*unit)};
    return {};
}

void SweepQueue::lost(int worker) {
    const auto found = seats_.find(worker);
    if (found == seats_.end()) return;
    const Seat seat = std::move(found->second);
    leave(worker);
    for (const long pattern : seat.verdicts) {
        if (state_[at(pattern)] != State::handed) continue;
        state_[at(pattern)] = State::left;
        returned_.push_back(pattern);
    }
    if (seat.place < 0) return;
    const auto open = open_.find(seat.pattern);
    if (open == open_.end() || state_at(open->second, seat.place) != State::handed) return;
    const int strand = strand_of(open->second, seat.place);
    state_at(open->second, seat.place) = State::left;
    open->second.waiting.insert(strand);
    ++open->second.available;
}

}  // namespace nsma
