#pragma once

#include <memory>
#include <optional>
#include <string>

namespace nsma::app {

/// The processes of one sweep. Started by mpirun (or srun) with several ranks, rank 0 schedules
/// and writes and every rank computes: rank 0 by a child process forked before MPI begins, so
/// that it answers while its child solves. Started alone there is no one else; MPI says whether
/// it is, since the variables of a launcher may be left over from another program.
class Crew {
public:
    Crew();
    /// Of rank 0: dismisses everyone and waits until they have ended the unit in hand.
    ~Crew();
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    [[nodiscard]] bool helper() const;  ///< this process only computes
    [[nodiscard]] int workers() const;  ///< that rank 0 can hand units to; 0: alone

    /// Rank 0: a result, or the news that a worker is gone.
    struct Message {
        int worker = 0;
        bool lost = false;
        std::string bytes;
    };
    void hand(int worker, const std::string& bytes);
    [[nodiscard]] bool present(int worker) const;
    /// The next message; absent when none came within a moment.
    [[nodiscard]] std::optional<Message> wait();

    /// Helpers: the next unit, absent when dismissed; and its result.
    [[nodiscard]] std::optional<std::string> next();
    void report(const std::string& bytes);
    /// Without a result for the unit in hand, which goes to others; there is no next one.
    void leave();

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace nsma::app
