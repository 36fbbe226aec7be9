#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "study/sweep/sweep_work.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {

/// What must be the same for stored results to be gone on with.
struct StoreVersions {
    std::string software;  ///< versions of the program and its solvers, one line
    std::string options;   ///< of the solvers, one line
};

/// The results of one sweep in one SQLite file: DIR/results.sqlite once the sweep is complete,
/// results.sqlite.part until then. Each result is committed as it comes, so that a kill loses
/// what is in flight only. Tables and columns: data/README.md. Throws InputError (one line)
/// when the file cannot be opened, read or written; what was committed stays valid.
class SweepStore {
public:
    enum class Mode {
        fresh,  ///< a new part file; complete results stay until it is complete
        resume  ///< goes on with the part file or the complete results, if there are any
    };
    /// Prepares the folder as SweepFolder does. A store of another scene, of other versions, or
    /// in use by another process is refused.
    SweepStore(const std::filesystem::path& folder, const Scene& scene, const StoreVersions& versions, Mode mode);
    /// Opens what a folder holds, to read: complete results, else the part file.
    explicit SweepStore(const std::filesystem::path& folder);
    ~SweepStore();
    SweepStore(const SweepStore&) = delete;
    SweepStore& operator=(const SweepStore&) = delete;

    /// In one commit: all are stored, or none is. A result that is stored already stays as it is.
    void put(const std::vector<WorkResult>& results);
    /// Hands on every result in the scene's order: each pattern, then its answers by place.
    void for_each(const std::function<void(WorkResult)>& visit) const;
    [[nodiscard]] const Scene& scene() const;
    [[nodiscard]] bool complete() const;
    [[nodiscard]] bool beside_complete() const;  ///< a part file, with complete results beside it
    [[nodiscard]] std::string file_name() const;
    [[nodiscard]] double seconds() const;  ///< time spent on it, over all runs that ended in order
    void add_seconds(double seconds);
    /// Marks the sweep as complete and gives the file its final name.
    void finish();

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace nsma
