#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "nsma/program/orbit_solver.hpp"
#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// One piece of a sweep that one process does by itself.
struct WorkUnit {
    long pattern = 0;  ///< position among patterns_of(scene)
    /// -1: decide the pattern; 0: its least-energy orbit; k >= 1: the k-th answer asked of it.
    int place = -1;
    /// `nearest` beyond the first level: beta of the orbit to stay near (nondimensional).
    std::vector<double> reference;
};

/// What came of it: a pattern record (place -1) or an answer.
struct WorkResult {
    long pattern = 0;
    int place = -1;
    std::optional<PatternRecord> record;
    std::optional<OrbitAnswer> answer;
};

/// Does units of one scene, reusing its solvers; keeps the last pattern's problem at hand. The
/// result of a unit does not depend on the units done before.
class SweepWorker {
public:
    SweepWorker(const Scene& scene, const OrbitSolverOptions& options);
    [[nodiscard]] WorkResult run(const WorkUnit& unit);

private:
    const Scene& scene_;
    std::vector<Pattern> patterns_;
    OrbitSolver solver_;
    long held_ = -1;
    PatternProblem problem_;
};

/// Which units of a sweep are left, and who has which: no clock, no input or output. A worker
/// goes on with the pattern it holds; then undecided patterns are taken, in the scene's order or
/// the longest first (m n_T estimates the work); at last, levels of patterns that others hold.
/// Its memory: a byte and a number a pattern, and the patterns in hand.
class SweepQueue {
public:
    enum class Order { scene, longest_first };
    SweepQueue(const Scene& scene, Order order);

    /// Marks a unit as done, by a worker or by a store read back.
    void done(const WorkResult& result);
    /// The next unit for this worker, which must not hold another; absent: nothing at present.
    [[nodiscard]] std::optional<WorkUnit> next(int worker);
    /// The worker is gone: its unit is handed out again.
    void lost(int worker);

    [[nodiscard]] bool finished() const { return undecided_ == 0 && open_.empty(); }
    [[nodiscard]] long done_count() const { return done_; }    ///< patterns and answers asked
    [[nodiscard]] long total_count() const { return total_; }  ///< as far as known

private:
    enum class State : std::uint8_t { undecided, handed, decided };
    enum class Place : std::uint8_t { left, handed, done };
    struct Open {
        std::vector<Place> places;
        int holder = -1;
        int reference_place = -1;
        std::vector<double> reference;
    };
    [[nodiscard]] std::optional<WorkUnit> take(long pattern, Open& open, int worker);

    bool chained_ = false;  // `nearest`: each level needs the one before
    int first_place_ = 0;
    int last_place_ = 0;
    std::vector<State> state_;
    std::vector<std::uint32_t> order_;
    std::size_t cursor_ = 0;
    std::vector<long> returned_;     // decisions of lost workers
    std::map<long, Open> open_;      // admissible patterns with places left
    std::map<int, WorkUnit> hands_;  // worker -> its unit
    long undecided_ = 0;
    long done_ = 0;
    long total_ = 0;
};

/// Adds a record to the counts; `asked` is false for the least-energy orbit, which counts only
/// when it failed or its replay is the worst.
void count(SweepSummary& summary, const PatternRecord& record);
void count(SweepSummary& summary, const OrbitAnswer& answer, bool asked);

}  // namespace nsma
