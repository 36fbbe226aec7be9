#include "sweep_store.hpp"

#include <chrono>
#include <cstdlib>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "database.hpp"
#include "store_tables.hpp"
#include "sweep_folder.hpp"
#include "orbit/fnv_hash.hpp"
#include "nsma/report/scene_file.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr const char* final_name = "results.sqlite";
constexpr const char* part_name = "results.sqlite.part";
// Raised with every change of the tables below, or of what a level's answer follows from.
constexpr const char* format = "3";

std::string hash_of(const std::string& text) {
    FnvHash hash;
    for (const char letter : text) hash.add(static_cast<unsigned char>(letter));
    return fmt::format("{:016x}", hash.value());
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
        } catch (const std::invalid_argument& error) {
            fail(file, fmt::format("cannot be {}: {}", doing, error.what()));
        } catch (const nlohmann::json::exception& error) {
            fail(file, fmt::format("cannot be {}: beta: {}", doing, error.what()));
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
                    database = std::make_unique<Database>(file, write);
                    return;
                } catch (const DatabaseError& error) {
                    if (i == tries || !error.locked()) throw;
                    std::this_thread::sleep_for(pause);
                }
            }
        });
    }

    [[nodiscard]] std::string info(const char* key) const {
        return guarded("read", [&] {
            DatabaseStatement query(*database, "SELECT value FROM sweep WHERE key = ?");
            query.select({}, {key});
            return query.step() ? query.text(0) : std::string();
        });
    }

    void set_info(const char* key, const std::string& value) {
        guarded("written", [&] {
            DatabaseStatement(*database, "INSERT OR REPLACE INTO sweep (key, value) VALUES (?, ?)")
                .insert({}, {key, value});
        });
    }

    [[nodiscard]] bool started() const {
        return guarded("read", [&] { return database->has_table("sweep"); });
    }

    void begin_anew(const StoreVersions& versions) {
        guarded("written", [&] {
            database->transaction([&] {
                database->execute("DROP VIEW IF EXISTS timings");
                database->execute("DROP TABLE IF EXISTS sweep");
                for (const StoreTable& table : store_tables()) {
                    database->execute(fmt::format("DROP TABLE IF EXISTS {}", table.name));
                }
                database->execute("CREATE TABLE sweep (key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID");
                for (const StoreTable& table : store_tables()) database->execute(table.create_sql());
                database->execute(timings_view_sql);
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
            });
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
            const auto& [patterns, answers, solves, orbits] = store_tables();
            inserts.emplace(Inserts{{*database, patterns.insert_sql()},
                                    {*database, answers.insert_sql()},
                                    {*database, solves.insert_sql()},
                                    {*database, orbits.insert_sql()}});
        });
    }

    void put(const ResultRows& rows) {
        if (rows.place < 0) return inserts->pattern.insert({rows.pattern}, rows.record);
        inserts->answer.insert({rows.pattern, rows.place}, rows.record);
        for (std::size_t run = 0; run < rows.runs.size(); ++run) {
            inserts->run.insert({rows.pattern, rows.place, static_cast<int>(run)}, rows.runs[run]);
        }
        if (rows.beta.empty()) return;
        inserts->orbit.insert({rows.pattern, rows.place}, {nlohmann::json(rows.beta).dump()});
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

double SweepStore::seconds() const { return std::strtod(implementation_->info("seconds").c_str(), nullptr); }

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
    Database& database = *self.database;
    const Bar& bar = self.scene.bar;
    self.guarded("read", [&] {
        DatabaseStatement patterns(database, "SELECT * FROM patterns ORDER BY number");
        DatabaseStatement answers(database, "SELECT * FROM answers WHERE pattern = ? ORDER BY place");
        DatabaseStatement runs(database, "SELECT * FROM solves WHERE pattern = ? AND place = ? ORDER BY run");
        DatabaseStatement orbit(database, "SELECT * FROM orbits WHERE pattern = ? AND place = ?");
        while (patterns.step()) {
            const long pattern = patterns.integer(0);
            visit(result_of({pattern, -1, patterns.row(1), {}, {}}, bar));
            answers.select({pattern});
            while (answers.step()) {
                ResultRows rows{pattern, static_cast<int>(answers.integer(1)), answers.row(2), {}, {}};
                runs.select({pattern, rows.place});
                while (runs.step()) rows.runs.push_back(runs.row(3));
                orbit.select({pattern, rows.place});
                if (orbit.step()) rows.beta = nlohmann::json::parse(orbit.text(2)).get<std::vector<double>>();
                visit(result_of(rows, bar));
            }
        }
    });
}

void SweepStore::finish() {
    auto& self = *implementation_;
    if (self.file.filename() != part_name) return;
    self.set_info("complete", "1");
    self.inserts.reset();
    self.guarded("written", [&] {
        // Everything into the one file, which is then whole by itself.
        self.database->execute("PRAGMA synchronous=FULL");
        self.database->execute("PRAGMA journal_mode=DELETE");
    });
    self.database.reset();
    std::error_code code;
    fs::rename(self.file, self.folder / final_name, code);
    if (code) fail(self.folder / final_name, fmt::format("cannot be written: {}", code.message()));
    self.open(self.folder / final_name, false);
}

std::string SweepStore::file_name() const { return implementation_->file.filename().string(); }

bool SweepStore::beside_complete() const {
    const auto& self = *implementation_;
    return self.file.filename() == part_name && fs::exists(self.folder / final_name);
}

}  // namespace nsma
