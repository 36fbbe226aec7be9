#include "sweep_queue.hpp"

#include <algorithm>
#include <numeric>

#include "orbit/index.hpp"

namespace nsma {
namespace {

// The first level of a strand starts cold: one in eight. Longer strands would save little more.
constexpr int warm_strand = 8;
// Verdicts in one message: about a millisecond of them, several times what rank 0 needs to hand them out and to store
// them. A verdict takes some 50 us, and more with m n_T.
constexpr double batch_work = 20'000;
constexpr double verdict_work = 1'000;

}  // namespace

SweepQueue::SweepQueue(const Scene& scene, const OrbitSolverOptions& options, Order order)
    : options_(options),
      all_kinds_(scene.all_kinds),
      nearest_(scene.objective == Objective::nearest),
      first_place_(is_extreme(scene.objective) || scene.bar.gap_sign() == 0 ? 1 : 0),
      last_place_(is_extreme(scene.objective) ? 1 : static_cast<int>(scene.levels.size())),
      cost_(scene, options),
      patterns_(patterns_of(scene)),
      state_(patterns_.size(), State::left),
      undecided_(static_cast<long>(patterns_.size())) {
    for (const Pattern& pattern : patterns_) {
        const SweepCost::Cost cost = cost_(pattern);
        total_ += cost.verdict + cost.answers;
    }
    order_.resize(patterns_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    const auto work = [this](std::uint32_t i) {
        return static_cast<double>(kernel_dimension(patterns_[i])) * patterns_[i].period_steps();
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

void SweepQueue::assign(int worker, Hold hold) {
    release(worker);
    const auto open = open_.find(hold.pattern);
    holds_[worker] = std::move(hold);
    if (open == open_.end()) return;
    ++open->second.workers;
    unheld_.erase(open->first);
}

void SweepQueue::release(int worker) {
    const auto hold = holds_.find(worker);
    if (hold == holds_.end()) return;
    const auto open = open_.find(hold->second.pattern);
    if (open != open_.end() && --open->second.workers == 0) unheld_.insert(open->first);
    holds_.erase(hold);
}

void SweepQueue::verdict_done(const WorkResult& result) {
    State& state = state_.at(index(result.pattern));
    if (state == State::done) return;
    state = State::done;
    --undecided_;
    const SweepCost::Cost cost = cost_(patterns_[index(result.pattern)]);
    done_ += cost.verdict;
    if (!is_solved(all_kinds_, result.record->kind) || last_place_ < first_place_) {
        done_ += cost.answers;  // none, but where too many unknowns forbid them
        return;
    }
    Open& open = open_[result.pattern];
    open.cost = cost;
    open.work_left = cost.answers;
    open.left = last_place_ + 1 - first_place_;
    open.done.resize(index(open.left));
    open.strand_length = nearest_ ? std::max(last_place_, 1) : ipopt_is_usual(options_) ? warm_strand : 1;
    for (int place = first_place_; place <= last_place_; place = open.strands.back().end) {
        const int end = place == 0 ? 1 : std::min(place + open.strand_length, last_place_ + 1);
        open.ready.insert(open.ready.end(), static_cast<int>(open.strands.size()));
        open.strands.push_back({place, end, {}});
    }
    open.workers = static_cast<int>(std::count_if(
        holds_.begin(), holds_.end(), [&](const auto& hold) { return hold.second.pattern == result.pattern; }));
    if (open.workers == 0) unheld_.insert(result.pattern);
}

std::int64_t SweepQueue::answer_work(const Open& open, const WorkResult& result) {
    if (result.place == 0) return 0;
    const Verdict verdict = result.answer->verdict;
    const bool inside = verdict == Verdict::admissible || verdict == Verdict::failed;
    return std::min(inside ? open.cost.inside : open.cost.outside, open.work_left);
}

void SweepQueue::done(const WorkResult& result) {
    if (result.place < 0) return verdict_done(result);
    const auto found = open_.find(result.pattern);
    if (found == open_.end()) return;
    Open& open = found->second;
    const auto slot = [this](int place) { return index(place - first_place_); };
    if (open.done.at(slot(result.place))) return;
    open.done[slot(result.place)] = true;
    const std::int64_t work = --open.left == 0 ? open.work_left : answer_work(open, result);
    done_ += work;
    open.work_left -= work;
    if (open.left == 0) {
        unheld_.erase(result.pattern);
        open_.erase(found);
        return;
    }
    const int number = strand_of(open, result.place);
    Strand& strand = open.strands[index(number)];
    const bool handed = !open.ready.contains(number) && strand.next != result.place;
    while (strand.next < strand.end && open.done[slot(strand.next)]) ++strand.next;
    if (strand.next == strand.end) {
        open.ready.erase(number);
        strand.before = {};
        return;
    }
    if (result.answer->orbit && result.place < strand.next) {
        strand.before.assign(result.answer->orbit->beta.begin(), result.answer->orbit->beta.end());
    }
    if (!handed) open.ready.insert(number);
}

// Of the worker's own strand, else of the first one that is ready.
std::optional<WorkUnit> SweepQueue::next_place(long pattern, int worker) {
    Open& open = open_.at(pattern);
    if (open.ready.empty()) return std::nullopt;
    const auto hold = holds_.find(worker);
    const bool own = hold != holds_.end() && hold->second.pattern == pattern && hold->second.place >= 0;
    auto number = own ? open.ready.find(strand_of(open, hold->second.place)) : open.ready.end();
    if (number == open.ready.end()) number = open.ready.begin();
    const Strand& strand = open.strands[index(*number)];
    open.ready.erase(number);
    assign(worker, {pattern, strand.next, {}});
    return WorkUnit{pattern, strand.next, strand.before};
}

std::vector<WorkUnit> SweepQueue::next_verdicts(int worker) {
    std::vector<long> patterns;
    const auto add = [&](long pattern) {
        if (state_[index(pattern)] == State::left) patterns.push_back(pattern);
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
        state_[index(pattern)] = State::handed;
        units.push_back({pattern, -1, {}});
    }
    if (!patterns.empty()) assign(worker, {patterns.back(), -1, patterns});  // the last one's problem is at hand then
    return units;
}

std::vector<WorkUnit> SweepQueue::next(int worker) {
    std::optional<WorkUnit> unit;
    const auto hold = holds_.find(worker);
    if (hold != holds_.end() && open_.contains(hold->second.pattern)) unit = next_place(hold->second.pattern, worker);
    if (!unit && !unheld_.empty()) unit = next_place(*unheld_.begin(), worker);
    if (unit) return {*unit};
    if (auto units = next_verdicts(worker); !units.empty()) return units;
    // With the pattern that has most strands left.
    const auto most = std::max_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
        return a.second.ready.size() < b.second.ready.size();
    });
    if (most != open_.end()) unit = next_place(most->first, worker);
    return unit ? std::vector{*unit} : std::vector<WorkUnit>();
}

void SweepQueue::lost(int worker) {
    const auto found = holds_.find(worker);
    if (found == holds_.end()) return;
    const Hold hold = found->second;
    release(worker);
    for (const long pattern : hold.verdicts) {
        if (state_[index(pattern)] != State::handed) continue;
        state_[index(pattern)] = State::left;
        returned_.push_back(pattern);
    }
    const auto open = open_.find(hold.pattern);
    if (hold.place < 0 || open == open_.end()) return;
    const int strand = strand_of(open->second, hold.place);
    if (open->second.strands[index(strand)].next == hold.place) open->second.ready.insert(strand);
}

}  // namespace nsma
