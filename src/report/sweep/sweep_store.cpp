#include "sweep_store.hpp"

#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "database.hpp"
#include "result_checksum.hpp"
#include "store_tables.hpp"
#include "sweep_folder.hpp"
#include "nsma/orbit/replay.hpp"
#include "nsma/report/scene_file.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

// Raised with every change of the tables below, or of what a level's answer follows from.
constexpr const char* format = "5";

// What is made for a new store: names, and the statements that make them.
std::vector<std::pair<std::string, std::string>> schema() {
    std::vector<std::pair<std::string, std::string>> all{
        {"sweep", "CREATE TABLE sweep (key TEXT PRIMARY KEY, value TEXT, checksum TEXT) WITHOUT ROWID"}};
    for (const StoreTable& table : store_tables()) all.emplace_back(table.name, table.create_sql());
    all.emplace_back("timings", timings_view_sql);
    return all;
}

// What the table `sweep` holds.
constexpr std::array info_keys{"format",  "scene", "scene_hash", "title",   "software",
                               "options", "kinds", "complete",   "results", "seconds"};

// A braced list of values would do, but for gcc 12: when memory ends in the middle of one it destroys what is not
// there.
RecordRow row_with(std::initializer_list<const std::string*> texts) {
    RecordRow row;
    for (const std::string* text : texts) row.emplace_back(*text);
    return row;
}

// Throws std::invalid_argument where the parts of a result contradict each other or its orbit is none.
void judge(const WorkResult& result) {
    if (!result.answer) return;
    const OrbitAnswer& answer = *result.answer;
    if ((answer.verdict == Verdict::admissible) != answer.orbit.has_value())
        throw std::invalid_argument("verdict: expected an orbit where it is admissible, and only there");
    if (answer.orbit && !replay(*answer.orbit, answer.level).accepted)
        throw std::invalid_argument("beta: expected an orbit, got one that its replay refuses");
}

}  // namespace

struct SweepStore::Implementation {
    fs::path folder;
    fs::path file;
    Scene scene;
    std::unique_ptr<Database> database;
    struct Inserts {
        DatabaseStatement pattern, answer, run, orbit;
    };
    std::optional<Inserts> inserts;

    // Every call into SQLite: its errors become one line that names the file.
    template <class Call>
    auto guarded(const char* doing, Call call) const {
        try {
            return call();
        } catch (const DatabaseError& error) {
            if (error.locked()) fail(file, "is in use by another process");
            fail(file, fmt::format("cannot be {}: {}", doing, error.what()));
        }
    }

    void open(const fs::path& path, bool write) {
        file = path;
        guarded("opened", [&] { database = std::make_unique<Database>(file, write); });
    }

    // Before anything is believed of a store that was there.
    void expect_sound() const {
        const std::string said = guarded("read", [&] {
            DatabaseStatement query(*database, "PRAGMA integrity_check(1)");
            query.select({});
            return query.step() ? query.text(0) : std::string("no answer");
        });
        if (said != "ok") damaged("file", said);
        for (const auto& [table, sql] : schema()) {
            const std::string stored = guarded("read", [&, name = table] {
                DatabaseStatement query(*database, "SELECT sql FROM sqlite_master WHERE name = ?");
                query.select({}, row_with({&name}));
                return query.step() ? query.text(0) : std::string();
            });
            if (stored != sql) damaged("table " + table, stored.empty() ? "is missing" : "has other columns");
        }
        for (const char* key : info_keys) (void)info(key);
    }

    [[noreturn]] void damaged(const std::string& where, const std::string& what) const {
        fail(file, fmt::format("is damaged: {}: {}", where, what));
    }

    [[nodiscard]] std::string info(const std::string& key) const {
        return guarded("read", [&] {
            DatabaseStatement query(*database, "SELECT value, checksum FROM sweep WHERE key = ?");
            query.select({}, row_with({&key}));
            const RecordRow row = query.step() ? query.row(0) : RecordRow();
            const std::string* value = row.empty() ? nullptr : std::get_if<std::string>(row.data());
            if (value == nullptr || row[1] != FieldValue(hash_of(key + "=" + *value)))
                damaged("table sweep, key " + key, "expected its value and checksum as written, got others");
            return *value;
        });
    }

    // Of whatever version wrote it.
    [[nodiscard]] std::string stored_format() const {
        return guarded("read", [&] {
            DatabaseStatement query(*database, "SELECT value FROM sweep WHERE key = 'format'");
            query.select({});
            return query.step() ? query.text(0) : std::string("none");
        });
    }

    void set_info(const std::string& key, const std::string& value) {
        guarded("written", [&] {
            const std::string sum = hash_of(key + "=" + value);
            DatabaseStatement(*database, "INSERT OR REPLACE INTO sweep (key, value, checksum) VALUES (?, ?, ?)")
                .insert({}, row_with({&key, &value, &sum}));
        });
    }

    // Rows by table, in words.
    static std::string count_text(const std::array<long, 4>& rows) {
        std::string text;
        for (std::size_t i = 0; i < rows.size(); ++i)
            text += fmt::format("{}{} {}", i > 0 ? ", " : "", rows.at(i), store_tables().at(i).name);
        return text;
    }
    [[nodiscard]] std::string count_results() const {
        return guarded("read", [&] {
            std::array<long, 4> rows{};
            for (std::size_t i = 0; i < rows.size(); ++i) {
                DatabaseStatement query(*database, fmt::format("SELECT count(*) FROM {}", store_tables().at(i).name));
                query.select({});
                (void)query.step();
                rows.at(i) = query.integer(0);
            }
            return count_text(rows);
        });
    }

    [[nodiscard]] bool started() const {
        return guarded("read", [&] { return database->has_table("sweep"); });
    }

    // Whatever a part file of before holds goes, unless another process has it.
    void begin_anew(const fs::path& part, const StoreVersions& versions) {
        if (fs::exists(part)) {
            try {
                Database(part, true);
            } catch (const DatabaseError& error) {
                if (error.locked()) fail(part, "is in use by another process");
            }
            for (const char* suffix : {"", "-wal", "-journal", "-shm"}) {
                std::error_code code;
                fs::remove(part.string() + suffix, code);
                if (code) fail(part, fmt::format("cannot be removed: {}", code.message()));
            }
        }
        open(part, true);
        guarded("written", [&] {
            database->transaction([&] {
                for (const auto& [table, sql] : schema()) database->execute(sql);
                const std::array<std::string, info_keys.size()> values{format,
                                                                       scene.text,
                                                                       hash_of(scene.text),
                                                                       scene.title,
                                                                       versions.software,
                                                                       versions.options,
                                                                       scene.all_kinds ? "all" : "contact",
                                                                       "0",
                                                                       "",
                                                                       "0"};
                for (std::size_t i = 0; i < values.size(); ++i) set_info(info_keys[i], values[i]);
            });
        });
    }

    void check(const StoreVersions& versions) const {
        const auto refuse = [&](const char* what, const std::string& stored, const std::string& now) {
            fail(file,
                 fmt::format("{}: expected {}, got a store of {}; give the same options, or begin anew with --fresh",
                             what, now, stored));
        };
        if (stored_format() != format) refuse("format of the store", stored_format(), format);
        expect_sound();
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
            const auto& [patterns, answers, solves, orbits] = store_tables();
            inserts.emplace(Inserts{{*database, patterns.insert_sql()},
                                    {*database, answers.insert_sql()},
                                    {*database, solves.insert_sql()},
                                    {*database, orbits.insert_sql()}});
        });
    }

    void put(ResultRows rows) {
        const std::string beta = rows.beta.empty() ? std::string() : nlohmann::json(rows.beta).dump();
        const std::int64_t sum = checksum(rows, beta);
        rows.record.emplace_back(sum);
        if (rows.place < 0) return inserts->pattern.insert({rows.pattern}, rows.record);
        inserts->answer.insert({rows.pattern, rows.place}, rows.record);
        for (std::size_t run = 0; run < rows.runs.size(); ++run) {
            inserts->run.insert({rows.pattern, rows.place, static_cast<int>(run)}, rows.runs[run]);
        }
        if (!beta.empty()) inserts->orbit.insert({rows.pattern, rows.place}, row_with({&beta}));
    }

    // The result of rows that were read; takes the checksum from the end of its record.
    [[nodiscard]] WorkResult result(ResultRows& rows, const std::string& beta) const {
        const std::string where = rows.place < 0
                                      ? fmt::format("table patterns, number {}", rows.pattern)
                                      : fmt::format("table answers, pattern {}, place {}", rows.pattern, rows.place);
        const FieldValue sum = rows.record.back();
        rows.record.pop_back();
        if (sum != FieldValue(checksum(rows, beta)))
            damaged(where, "expected it with its solves and orbit as written, got others");
        try {
            if (!beta.empty()) rows.beta = nlohmann::json::parse(beta).get<std::vector<double>>();
            WorkResult result = result_of(rows, scene.bar);
            judge(result);
            return result;
        } catch (const std::exception& error) {
            damaged(where, error.what());
        }
    }
};

SweepStore::SweepStore(const fs::path& folder, const Scene& scene, const StoreVersions& versions, Mode mode)
    : implementation_(std::make_unique<Implementation>()) {
    auto& self = *implementation_;
    prepare_sweep_folder(folder, scene);
    self.folder = folder;
    self.scene = scene;
    const fs::path part = folder / store_part_name;
    const bool has_part = fs::exists(part);
    if (mode == Mode::resume && !has_part && fs::exists(folder / store_name)) {
        self.open(folder / store_name, false);
        self.check(versions);
        return;
    }
    bool goes_on = false;
    if (mode == Mode::resume && has_part) {
        self.open(part, true);
        goes_on = self.started();
    }
    if (goes_on) {
        self.check(versions);
    } else {
        self.database.reset();
        self.begin_anew(part, versions);
    }
    self.prepare();
}

SweepStore::SweepStore(const fs::path& folder) : implementation_(std::make_unique<Implementation>()) {
    auto& self = *implementation_;
    self.folder = folder;
    expect_sweep_folder(folder);
    const bool final = fs::exists(folder / store_name);
    // A part file may have a journal to take in, which is writing.
    self.open(folder / (final ? store_name : store_part_name), !final);
    if (!self.started()) fail(self.file, "expected the results of a sweep, got an empty store");
    if (self.stored_format() != format) {
        fail(self.file, fmt::format("format of the store: expected {}, got {}", format, self.stored_format()));
    }
    self.expect_sound();
    self.scene = parse_scene(self.info("scene"), self.file.string());
    self.scene.all_kinds = self.info("kinds") == "all";
}

SweepStore::~SweepStore() = default;

const Scene& SweepStore::scene() const { return implementation_->scene; }

bool SweepStore::complete() const { return implementation_->info("complete") == "1"; }

double SweepStore::seconds() const {
    const std::string text = implementation_->info("seconds");
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

void SweepStore::add_seconds(double more) { implementation_->set_info("seconds", fmt::format("{}", seconds() + more)); }

void SweepStore::put(const std::vector<WorkResult>& results) {
    auto& self = *implementation_;
    self.guarded("written", [&] {
        // Without its commit it is rolled back; what was committed before stays valid.
        self.database->transaction([&] {
            for (const WorkResult& result : results) self.put(rows_of(result));
        });
    });
}

void SweepStore::for_each(const std::function<void(WorkResult)>& visit) const {
    const auto& self = *implementation_;
    struct Queries {
        DatabaseStatement patterns, answers, runs, orbit;
    };
    Queries query = self.guarded("read", [&] {
        Database& database = *self.database;
        return Queries{{database, "SELECT * FROM patterns ORDER BY number"},
                       {database, "SELECT * FROM answers WHERE pattern = ? ORDER BY place"},
                       {database, "SELECT * FROM solves WHERE pattern = ? AND place = ? ORDER BY run"},
                       {database, "SELECT * FROM orbits WHERE pattern = ? AND place = ?"}};
    });
    // Each reads the next result, false where there is none. What `visit` throws is none of the store's.
    ResultRows rows;
    std::string beta;
    const auto next_pattern = [&] {
        if (!query.patterns.step()) return false;
        rows = {query.patterns.integer(0), -1, query.patterns.row(1), {}, {}};
        beta.clear();
        query.answers.select({rows.pattern});
        return true;
    };
    const auto next_answer = [&] {
        if (!query.answers.step()) return false;
        rows = {rows.pattern, static_cast<int>(query.answers.integer(1)), query.answers.row(2), {}, {}};
        query.runs.select({rows.pattern, rows.place});
        while (query.runs.step()) rows.runs.push_back(query.runs.row(3));
        query.orbit.select({rows.pattern, rows.place});
        beta = query.orbit.step() ? query.orbit.text(2) : std::string();
        return true;
    };
    std::array<long, 4> seen{};
    auto& [patterns, answers, solves, orbits] = seen;
    for (; self.guarded("read", next_pattern); ++patterns) {
        visit(self.result(rows, beta));
        for (; self.guarded("read", next_answer); ++answers) {
            solves += static_cast<long>(rows.runs.size());
            if (!beta.empty()) ++orbits;
            visit(self.result(rows, beta));
        }
    }
    const std::string found = Implementation::count_text(seen);
    const std::string expected = complete() ? self.info("results") : found;
    if (self.count_results() != found || expected != found)
        self.damaged("file", fmt::format("expected {}, got {} of {}", expected, found, self.count_results()));
}

void SweepStore::finish() {
    auto& self = *implementation_;
    if (self.file.filename() != store_part_name) return;
    self.set_info("results", self.count_results());
    self.set_info("complete", "1");
    self.inserts.reset();
    self.guarded("written", [&] {
        // Everything into the one file, which is then whole by itself.
        self.database->execute("PRAGMA synchronous=FULL");
        self.database->execute("PRAGMA journal_mode=DELETE");
    });
    self.database.reset();
    std::error_code code;
    fs::rename(self.file, self.folder / store_name, code);
    if (code) fail(self.folder / store_name, fmt::format("cannot be written: {}", code.message()));
    self.open(self.folder / store_name, false);
}

std::string SweepStore::file_name() const { return implementation_->file.filename().string(); }

bool SweepStore::beside_complete() const {
    const auto& self = *implementation_;
    return self.file.filename() == store_part_name && fs::exists(self.folder / store_name);
}

}  // namespace nsma
