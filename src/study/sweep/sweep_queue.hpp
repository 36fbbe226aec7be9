#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "sweep_cost.hpp"
#include "sweep_work.hpp"

namespace nsma {

/// Which units of a sweep are left, and who has which: no clock, no input or output. A worker
/// goes on with the pattern it holds; then undecided patterns are taken, in the scene's order or
/// the longest first (m n_T estimates the work); at last, levels of patterns that others hold.
///
/// Levels that start from each other's orbits form a strand, which one worker has at a time: all
/// levels of a pattern for `nearest`; eight in a row where Ipopt is usually asked, so that most of
/// them begin near their optimum and a long list of levels still divides among many workers; else one.
/// A level's result so depends on its strand alone, not on who did what when.
///
/// Verdicts take microseconds: of the longest first, several are handed out together.
///
/// Its memory: some twenty bytes a pattern, some hundred a strand of the patterns in hand.
class SweepQueue {
public:
    enum class Order { scene, longest_first };
    SweepQueue(const Scene& scene, const OrbitSolverOptions& options, Order order);

    /// Marks a unit as done, by a worker or by a store read back.
    void done(const WorkResult& result);
    /// The next units for this worker, which must not hold others: verdicts, or one answer. Empty: nothing at present.
    [[nodiscard]] std::vector<WorkUnit> next(int worker);
    /// The worker is gone: its units are handed out again.
    void lost(int worker);

    [[nodiscard]] bool finished() const { return undecided_ == 0 && open_.empty(); }
    /// As SweepCost estimates it; the total never changes, and all of it is done at the end.
    [[nodiscard]] std::int64_t work_done() const { return done_; }
    [[nodiscard]] std::int64_t work_total() const { return total_; }

private:
    enum class State : std::uint8_t { left, handed, done };
    // Places that one worker does in their order.
    struct Strand {
        int next = 0;                // place; those before it are done
        int end = 0;                 // the place after its last
        std::vector<double> before;  // beta of its last orbit
    };
    // An admissible pattern with places left.
    struct Open {
        std::vector<bool> done;  // by place, from first_place_ on
        int left = 0;            // places not done
        int strand_length = 1;
        std::vector<Strand> strands;
        std::set<int> ready;  // strands that are neither done nor handed
        int workers = 0;      // that hold it
        SweepCost::Cost cost;
        std::int64_t work_left = 0;  // of its answers
    };
    // What a worker has in hand, or had last.
    struct Hold {
        long pattern = 0;
        int place = -1;
        std::vector<long> verdicts;  // patterns; place -1
    };

    [[nodiscard]] int strand_of(const Open& open, int place) const;
    void assign(int worker, Hold hold);
    void release(int worker);
    void verdict_done(const WorkResult& result);
    [[nodiscard]] static std::int64_t answer_work(const Open& open, const WorkResult& result);
    [[nodiscard]] std::optional<WorkUnit> next_place(long pattern, int worker);
    [[nodiscard]] std::vector<WorkUnit> next_verdicts(int worker);

    OrbitSolverOptions options_;
    bool all_kinds_ = false;
    bool nearest_ = false;
    int first_place_ = 0;
    int last_place_ = 0;
    SweepCost cost_;
    std::vector<Pattern> patterns_;
    std::vector<State> state_;  // of each pattern's verdict
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> batches_;  // ends of the pieces of order_ that are handed out together
    std::size_t batch_ = 0;
    std::vector<long> returned_;  // verdicts of lost workers
    std::map<long, Open> open_;
    std::set<long> unheld_;  // open patterns without a worker: of an earlier run, or of lost workers
    std::map<int, Hold> holds_;
    long undecided_ = 0;
    std::int64_t done_ = 0;
    std::int64_t total_ = 0;
};

}  // namespace nsma
