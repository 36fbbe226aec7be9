#include "sweep_store.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <iterator>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "sweep_folder.hpp"
#include "study/sweep/record_rows.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/results_folder.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr const char* final_name = "results.sqlite";
constexpr const char* part_name = "results.sqlite.part";
// Raised with every change of the tables below, or of what a level's answer follows from.
constexpr const char* format = "3";

std::string hash_of(const std::string& text) {
    std::uint64_t hash = 14695981039346656037U;  // FNV-1a
    for (const char letter : text) {
        hash ^= static_cast<unsigned char>(letter);
        hash *= 1099511628211U;
    }
    return fmt::format("{:016x}", hash);
}

// A JSON list of the shortest decimals that read back to the same doubles.
std::string list_of(const std::vector<double>& values) {
    std::string text = "[";
    for (const double value : values) {
        if (text.size() > 1) text += ',';
        fmt::format_to(std::back_inserter(text), "{}", value);
    }
    return text + ']';
}

std::vector<double> numbers_in(const std::string& text) {
    std::vector<double> values;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at != end) {
        ++at;  // '[', ',' or ']'
        if (at == end) break;
        double value = 0;
        const auto [next, code] = std::from_chars(at, end, value);
        if (code != std::errc()) throw std::invalid_argument("beta: expected a list of numbers");
        values.push_back(value);
        at = next;
    }
    return values;
}

std::string columns_sql(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += ", " + name;
    return text;
}

std::string insert_sql(const std::string& table, const std::string& keys, const std::vector<std::string>& names) {
    std::string marks = "?";
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::count(keys.begin(), keys.end(), ',')) + names.size();
         ++i) {
        marks += ",?";
    }
    return fmt::format("INSERT OR IGNORE INTO {} ({}{}) VALUES ({})", table, keys, columns_sql(names), marks);
}

void bind(SQLite::Statement& statement, int from, const Row& row) {
    for (const Value& value : row) {
        if (const auto* whole = std::get_if<std::int64_t>(&value)) {
            statement.bind(from, *whole);
        } else if (const auto* real = std::get_if<double>(&value)) {
            statement.bind(from, *real);
        } else if (const auto* text = std::get_if<std::string>(&value)) {
            statement.bind(from, *text);
        } else {
            statement.bind(from);
        }
        ++from;
    }
}

Row row_of(SQLite::Statement& statement, int from) {
    Row row;
    for (int i = from; i < statement.getColumnCount(); ++i) {
        const SQLite::Column column = statement.getColumn(i);
        if (column.isInteger()) {
            row.emplace_back(column.getInt64());
        } else if (column.isFloat()) {
            row.emplace_back(column.getDouble());
        } else if (column.isText()) {
            row.emplace_back(column.getString());
        } else {
            row.emplace_back();
        }
    }
    return row;
}

const char* const view_sql =
    "CREATE VIEW timings AS"
    " SELECT number, NULL AS place, 'pattern' AS what, NULL AS run, seconds FROM patterns"
    " UNION ALL SELECT pattern, place, 'answer', NULL, seconds FROM answers"
    " UNION ALL SELECT pattern, place, solver, run, seconds FROM solves";

}  // namespace

struct SweepStore::Implementation {
    fs::path folder;
    fs::path file;
    Scene scene;
    std::unique_ptr<SQLite::Database> database;
    std::optional<SQLite::Statement> add_pattern, add_answer, add_run, add_orbit, begin, commit, rollback;

    // Every call into SQLite: its errors become one line that names the file.
    template <class Call>
    auto guarded(const char* doing, Call call) const {
        try {
            return call();
        } catch (const SQLite::Exception& error) {
            if (is_locked(error)) fail(file, "is in use by another process");
            fail(file, fmt::format("cannot be {}: {}", doing, error.getErrorStr()));
        } catch (const std::invalid_argument& error) {
            fail(file, fmt::format("cannot be {}: {}", doing, error.what()));
        }
    }

    void open(const fs::path& path, bool write) {
        file = path;
        guarded("opened", [&] {
            // A process that just ended may still be letting go of the file, and SQLite takes an exclusive lock of a
            // journal without waiting.
            constexpr int tries = 60;
            constexpr std::chrono::milliseconds pause{50};
            for (int i = 1;; ++i) {
                try {
                    return connect(write);
                } catch (const SQLite::Exception& error) {
                    database.reset();
                    if (i == tries || !is_locked(error)) throw;
                    std::this_thread::sleep_for(pause);
                }
            }
        });
    }

    void connect(bool write) {
        const int flags = write ? SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE : SQLite::OPEN_READONLY;
        database = std::make_unique<SQLite::Database>(file.string(), flags);
        if (!write) return;
        // One writer, no shared memory: also safe on a network file system.
        database->exec("PRAGMA locking_mode=EXCLUSIVE");
        database->exec("PRAGMA journal_mode=WAL");
        database->exec("PRAGMA synchronous=NORMAL");
        database->exec("BEGIN EXCLUSIVE");
        database->exec("COMMIT");
    }

    static bool is_locked(const SQLite::Exception& error) {
        return error.getErrorCode() == 5 || error.getErrorCode() == 6;  // SQLITE_BUSY, SQLITE_LOCKED
    }

    void close() {
        for (auto* statement : {&add_pattern, &add_answer, &add_run, &add_orbit, &begin, &commit, &rollback})
            statement->reset();
        database.reset();
    }

    [[nodiscard]] std::string info(const char* key) const {
        return guarded("read", [&] {
            SQLite::Statement query(*database, "SELECT value FROM sweep WHERE key = ?");
            query.bind(1, key);
            return query.executeStep() ? query.getColumn(0).getString() : std::string();
        });
    }

    void set_info(const char* key, const std::string& value) {
        guarded("written", [&] {
            SQLite::Statement set(*database, "INSERT OR REPLACE INTO sweep (key, value) VALUES (?, ?)");
            set.bind(1, key);
            set.bind(2, value);
            set.exec();
        });
    }

    [[nodiscard]] bool started() const {
        return guarded("read", [&] { return database->tableExists("sweep"); });
    }

    void begin_anew(const StoreVersions& versions) {
        guarded("written", [&] {
            SQLite::Transaction transaction(*database);
            database->exec("DROP VIEW IF EXISTS timings");
            for (const char* table : {"orbits", "solves", "answers", "patterns", "sweep"}) {
                database->exec(fmt::format("DROP TABLE IF EXISTS {}", table));
            }
            database->exec("CREATE TABLE sweep (key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID");
            database->exec(
                fmt::format("CREATE TABLE patterns (number INTEGER PRIMARY KEY{})", columns_sql(pattern_columns())));
            database->exec(
                fmt::format("CREATE TABLE answers (pattern INTEGER, place INTEGER{}, PRIMARY KEY (pattern, place))",
                            columns_sql(answer_columns())));
            database->exec(
                fmt::format("CREATE TABLE solves (pattern INTEGER, place INTEGER, run INTEGER{}, PRIMARY KEY (pattern, "
                            "place, run))",
                            columns_sql(run_columns())));
            database->exec(
                "CREATE TABLE orbits (pattern INTEGER, place INTEGER, beta TEXT, PRIMARY KEY (pattern, place))");
            database->exec(view_sql);
            for (const auto& [key, value] : {std::pair<const char*, std::string>{"format", format},
                                             {"scene", scene.text},
                                             {"scene_hash", hash_of(scene.text)},
                                             {"title", scene.title},
                                             {"software", versions.software},
                                             {"options", versions.options},
                                             {"kinds", scene.all_kinds ? "all" : "contact"},
                                             {"complete", "0"},
                                             {"seconds", "0"}}) {
                set_info(key, value);
            }
            transaction.commit();
        });
    }

    void check(const StoreVersions& versions) const {
        const auto refuse = [&](const char* what, const std::string& stored, const std::string& now) {
            fail(file, fmt::format("{}: expected {}, got a store of {}; choose another folder or run without --resume",
                                   what, now, stored));
        };
        if (info("format") != format) refuse("format of the store", info("format"), format);
        if (info("scene") != scene.text) {
            fail(file,
                 fmt::format("holds results of another scene (hash {}, not {}); choose another folder or remove it",
                             info("scene_hash"), hash_of(scene.text)));
        }
        if (info("software") != versions.software) refuse("software", info("software"), versions.software);
        if (info("options") != versions.options) refuse("options", info("options"), versions.options);
    }

    void prepare() {
        guarded("opened", [&] {
            add_pattern.emplace(*database, insert_sql("patterns", "number", pattern_columns()));
            add_answer.emplace(*database, insert_sql("answers", "pattern, place", answer_columns()));
            add_run.emplace(*database, insert_sql("solves", "pattern, place, run", run_columns()));
            add_orbit.emplace(*database, insert_sql("orbits", "pattern, place, beta", {}));
            begin.emplace(*database, "BEGIN");
            commit.emplace(*database, "COMMIT");
            rollback.emplace(*database, "ROLLBACK");
        });
    }

    static void run(std::optional<SQLite::Statement>& statement) {
        statement->exec();
        statement->reset();
    }

    void add(std::optional<SQLite::Statement>& statement, const WorkResult& result, int keys, int number,
             const Row& row) {
        statement->bind(1, static_cast<std::int64_t>(result.pattern));
        if (keys > 1) statement->bind(2, result.place);
        if (keys > 2) statement->bind(3, number);
        bind(*statement, keys + 1, row);
        run(statement);
    }

    void put(const WorkResult& result) {
        const ResultRows rows = rows_of(result);
        if (result.place < 0) {
            add(add_pattern, result, 1, 0, rows.pattern);
            return;
        }
        add(add_answer, result, 2, 0, rows.answer);
        int number = 0;
        for (const Row& row : rows.runs) add(add_run, result, 3, number++, row);
        if (!rows.beta.empty()) add(add_orbit, result, 2, 0, {Value(list_of(rows.beta))});
    }
};

SweepStore::SweepStore(const fs::path& folder, const Scene& scene, const StoreVersions& versions, Mode mode)
    : implementation_(std::make_unique<Implementation>()) {
    auto& self = *implementation_;
    prepare_sweep_folder(folder, scene);
    self.folder = folder;
    self.scene = scene;
    const fs::path part = folder / part_name;
    const bool has_part = fs::exists(part);
    if (mode == Mode::resume && !has_part && fs::exists(folder / final_name)) {
        self.open(folder / final_name, false);
        self.check(versions);
        return;
    }
    self.open(part, true);
    if (mode == Mode::resume && self.started()) {
        self.check(versions);
    } else {
        self.begin_anew(versions);
    }
    self.prepare();
}

SweepStore::SweepStore(const fs::path& folder) : implementation_(std::make_unique<Implementation>()) {
    auto& self = *implementation_;
    self.folder = folder;
    const bool final = fs::exists(folder / final_name);
    if (!final && !fs::exists(folder / part_name)) {
        fail(folder, fmt::format("expected the folder of a sweep, got one without {}", final_name));
    }
    // A part file may have a journal to take in, which is writing.
    self.open(folder / (final ? final_name : part_name), !final);
    if (!self.started()) fail(self.file, "expected the results of a sweep, got an empty store");
    if (self.info("format") != format) {
        fail(self.file, fmt::format("format of the store: expected {}, got {}", format, self.info("format")));
    }
    self.scene = parse_scene(self.info("scene"), self.file.string());
    self.scene.all_kinds = self.info("kinds") == "all";
}

SweepStore::~SweepStore() = default;

const Scene& SweepStore::scene() const { return implementation_->scene; }

bool SweepStore::complete() const { return implementation_->info("complete") == "1"; }

double SweepStore::seconds() const {
    const auto numbers = numbers_in(fmt::format("[{}]", implementation_->info("seconds")));
    return numbers.empty() ? 0.0 : numbers.front();
}

void SweepStore::add_seconds(double more) { implementation_->set_info("seconds", fmt::format("{}", seconds() + more)); }

void SweepStore::put(const std::vector<WorkResult>& results) {
    auto& self = *implementation_;
    self.guarded("written", [&] {
        Implementation::run(self.begin);
        try {
            for (const WorkResult& result : results) self.put(result);
            Implementation::run(self.commit);
        } catch (...) {
            // What was committed before stays valid; a journal cut short is ignored when read.
            try {
                Implementation::run(self.rollback);
            } catch (const SQLite::Exception&) {  // SQLite has rolled back by itself
            }
            throw;
        }
    });
}

void SweepStore::for_each(const std::function<void(WorkResult)>& visit) const {
    const auto& self = *implementation_;
    SQLite::Database& database = *self.database;
    std::optional<SQLite::Statement> patterns, answers, runs, orbit;
    self.guarded("read", [&] {
        patterns.emplace(database,
                         fmt::format("SELECT number{} FROM patterns ORDER BY number", columns_sql(pattern_columns())));
        answers.emplace(database, fmt::format("SELECT place{} FROM answers WHERE pattern = ? ORDER BY place",
                                              columns_sql(answer_columns())));
        runs.emplace(database, fmt::format("SELECT run{} FROM solves WHERE pattern = ? AND place = ? ORDER BY run",
                                           columns_sql(run_columns())));
        orbit.emplace(database, "SELECT beta FROM orbits WHERE pattern = ? AND place = ?");
    });
    // One result at a time; `visit` may throw what it likes.
    const auto next_pattern = [&]() -> std::optional<WorkResult> {
        return self.guarded("read", [&]() -> std::optional<WorkResult> {
            if (!patterns->executeStep()) return std::nullopt;
            return WorkResult{static_cast<long>(patterns->getColumn(0).getInt64()), -1,
                              pattern_record_of(row_of(*patterns, 1)), std::nullopt};
        });
    };
    const auto next_answer = [&](long pattern) -> std::optional<WorkResult> {
        return self.guarded("read", [&]() -> std::optional<WorkResult> {
            if (!answers->executeStep()) return std::nullopt;
            const int place = answers->getColumn(0).getInt();
            ResultRows rows;
            rows.answer = row_of(*answers, 1);
            runs->reset();
            runs->bind(1, static_cast<std::int64_t>(pattern));
            runs->bind(2, place);
            while (runs->executeStep()) rows.runs.push_back(row_of(*runs, 1));
            orbit->reset();
            orbit->bind(1, static_cast<std::int64_t>(pattern));
            orbit->bind(2, place);
            if (orbit->executeStep()) rows.beta = numbers_in(orbit->getColumn(0).getString());
            return WorkResult{pattern, place, std::nullopt, orbit_answer_of(rows, self.scene.bar)};
        });
    };
    while (auto record = next_pattern()) {
        const long pattern = record->pattern;
        visit(std::move(*record));
        self.guarded("read", [&] {
            answers->reset();
            answers->bind(1, static_cast<std::int64_t>(pattern));
        });
        while (auto answer = next_answer(pattern)) visit(std::move(*answer));
    }
}

void SweepStore::finish() {
    auto& self = *implementation_;
    if (self.file.filename() != part_name) return;
    self.set_info("complete", "1");
    for (auto* statement : {&self.add_pattern, &self.add_answer, &self.add_run, &self.add_orbit, &self.begin,
                            &self.commit, &self.rollback}) {
        statement->reset();
    }
    self.guarded("written", [&] {
        // Everything into the one file, which is then whole by itself.
        self.database->exec("PRAGMA synchronous=FULL");
        self.database->exec("PRAGMA journal_mode=DELETE");
    });
    self.close();
    std::error_code code;
    fs::rename(self.file, self.folder / final_name, code);
    if (code) fail(self.folder / final_name, fmt::format("cannot be written: {}", code.message()));
    self.open(self.folder / final_name, false);
}

bool SweepStore::in(const fs::path& folder) {
    std::error_code code;
    return fs::exists(folder / final_name, code) || fs::exists(folder / part_name, code);
}

bool SweepStore::beside_complete() const {
    const auto& self = *implementation_;
    return self.file.filename() == part_name && fs::exists(self.folder / final_name);
}

namespace {

// The motions of the answers so far, by level.
class SeenMotions {
public:
    // Whether an answer at this place came before with the same motion; if not, it is one from now on.
    bool before(const OrbitAnswer& answer, int place) {
        const auto motion = answer.orbit ? least_label(*answer.orbit) : std::nullopt;
        if (!motion) return false;
        bool known = false;
        const auto numbers = fingerprints(*motion);
        for (std::size_t grid = 0; grid < numbers.size(); ++grid)
            known = !seen_.at(grid).emplace(place, numbers.at(grid)).second || known;
        return known;
    }

private:
    std::array<std::set<std::pair<int, std::uint64_t>>, 2> seen_;
};

}  // namespace

Exported export_sweep(const SweepStore& store, const fs::path& folder, bool distinct) {
    SweepSummary summary;
    std::optional<SweepFolder> files;
    SeenMotions seen;
    if (!store.beside_complete()) files.emplace(folder, store.scene());
    store.for_each([&](const WorkResult& result) {
        if (result.record) {
            count(summary, *result.record, store.scene().all_kinds);
            if (files) files->pattern(*result.record);
        }
        if (result.answer) {
            count(summary, *result.answer, result.place > 0);
            const bool copy = seen.before(*result.answer, result.place);
            if (copy && result.place > 0) ++summary.copies;
            if (files) files->answer(*result.answer, copy && distinct);
        }
    });
    summary.seconds = store.seconds();
    summary.interrupted = !store.complete();
    if (files) {
        std::string line = files->finish(summary);
        if (summary.interrupted) line += "; --resume goes on with them";
        return {summary, std::move(line)};
    }
    return {summary, fmt::format("interrupted: {} keeps its complete results; what was done now is in {}, and "
                                 "--resume goes on with it",
                                 folder.string(), part_name)};
}

}  // namespace nsma
