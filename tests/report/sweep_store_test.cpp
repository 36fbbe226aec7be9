#include "report/sweep/sweep_store.hpp"

#include <csignal>
#include <random>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "../study/run_sweep.hpp"
#include "../support/sweep_scene.hpp"
#include "sample.hpp"
#include "study/sweep/sweep_queue.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/sweep/sweep_export.hpp"

namespace nsma {
namespace {

using sample::error_of;
using testing::HasSubstr;
using Mode = SweepStore::Mode;

/// Writes tables without a store between.
class TableSink : public SweepSink {
public:
    TableSink(const std::filesystem::path& path, const Scene& scene) : folder(path, scene) {}
    void pattern(const PatternRecord& record) override { folder.pattern(record); }
    void answer(const OrbitAnswer& answer) override { folder.answer(answer); }
    void progress(long, long) override {}

    SweepFolder folder;
};

class SweepStoreTest : public sample::Folder {
protected:
    Scene scene = parse_scene(sweep_scene_text, "sample");
    StoreVersions versions{"nsma 1", "solver both"};

    /// Does up to `limit` further units, as nsma sweep does; true when none is left.
    bool work(SweepStore& store, int limit = 1'000'000) {
        SweepQueue queue(scene, {}, SweepQueue::Order::scene);
        store.for_each([&queue](const WorkResult& result) { queue.done(result); });
        SweepWorker worker(scene, {});
        for (; limit > 0 && !queue.finished(); --limit) {
            const auto results = worker.run(queue.next(0));
            store.put(results);
            for (const WorkResult& result : results) queue.done(result);
        }
        return queue.finished();
    }
    std::string whole(const std::filesystem::path& folder) {
        SweepStore store(folder, scene, versions, Mode::fresh);
        EXPECT_TRUE(work(store));
        store.add_seconds(1.5);
        store.finish();
        return export_sweep(store, folder).line;
    }
    void expect_same_tables(const std::filesystem::path& a, const std::filesystem::path& b) {
        for (const char* name : {"scene.toml", "patterns.csv", "levels.csv", "orbits.jsonl"}) {
            EXPECT_EQ(sample::read(a / name), sample::read(b / name)) << name;
            EXPECT_FALSE(sample::read(a / name).empty()) << name;
        }
        auto first = nlohmann::json::parse(sample::read(a / "summary.json"));
        auto second = nlohmann::json::parse(sample::read(b / "summary.json"));
        first.erase("seconds");
        second.erase("seconds");
        EXPECT_EQ(first, second);
    }
};

TEST_F(SweepStoreTest, TablesAreThoseOfASweepWithoutAStore) {
    EXPECT_THAT(whole(path / "store"), HasSubstr("results are in"));
    EXPECT_TRUE(std::filesystem::exists(path / "store" / "results.sqlite"));
    EXPECT_FALSE(std::filesystem::exists(path / "store" / "results.sqlite.part"));
    TableSink direct(path / "direct", scene);
    direct.folder.finish(sweep(scene, {}, direct, [] { return true; }));
    expect_same_tables(path / "store", path / "direct");
    EXPECT_THAT(sample::read(path / "store" / "summary.json"), HasSubstr("\"seconds\": 1.5"));
}

TEST_F(SweepStoreTest, GoesOnFromEveryUnitToTheSameTables) {
    (void)whole(path / "whole");
    for (int done = 0; done < 14; ++done) {
        const auto folder = path / std::to_string(done);
        for (bool finished = false; !finished;) {
            SweepStore store(folder, scene, versions, Mode::resume);
            finished = work(store, done + 1);
            if (finished) {
                store.finish();
                (void)export_sweep(store, folder);
            }
        }
        expect_same_tables(folder, path / "whole");
    }
}

TEST_F(SweepStoreTest, ResumingACompleteStoreChangesNothing) {
    (void)whole(path);
    const std::string before = sample::read(path / "results.sqlite");
    SweepStore store(path, scene, versions, Mode::resume);
    EXPECT_TRUE(store.complete());
    EXPECT_TRUE(work(store, 0));
    (void)export_sweep(store, path);
    EXPECT_EQ(sample::read(path / "results.sqlite"), before);
}

TEST_F(SweepStoreTest, AFreshRunKeepsCompleteResultsUntilItsEnd) {
    (void)whole(path);
    const std::string before = sample::read(path / "levels.csv");
    {
        SweepStore store(path, scene, versions, Mode::fresh);
        EXPECT_FALSE(work(store, 3));
        EXPECT_THAT(export_sweep(store, path).line, HasSubstr("keeps its complete results"));
        EXPECT_EQ(sample::read(path / "levels.csv"), before);
        EXPECT_TRUE(SweepStore(path).complete());
    }
    SweepStore store(path, scene, versions, Mode::resume);
    EXPECT_FALSE(store.complete());
    EXPECT_TRUE(work(store));
    store.finish();
    EXPECT_THAT(export_sweep(store, path).line, HasSubstr("results are in"));
    EXPECT_EQ(sample::read(path / "levels.csv"), before);
}

TEST_F(SweepStoreTest, NothingIsDoubled) {
    SweepStore store(path, scene, versions, Mode::fresh);
    SweepWorker worker(scene, {});
    for (int time = 0; time < 2; ++time) {
        store.put({worker.run(WorkUnit{0, -1, {}})});
        store.put({worker.run(WorkUnit{0, 0, {}})});
    }
    int count = 0;
    store.for_each([&count](const WorkResult&) { ++count; });
    EXPECT_EQ(count, 2);
}

TEST_F(SweepStoreTest, AnotherSceneOrVersionIsRefused) {
    {
        SweepStore store(path, scene, versions, Mode::fresh);
        (void)work(store, 2);
    }
    const auto message = [&](const StoreVersions& other) {
        return error_of([&] { SweepStore(path, scene, other, Mode::resume); });
    };
    EXPECT_THAT(message({"nsma 2", "solver both"}), HasSubstr("software: expected nsma 2, got a store of nsma 1"));
    EXPECT_THAT(message({"nsma 1", "solver ipopt"}), HasSubstr("options: expected solver ipopt"));
    EXPECT_EQ(message(versions), "no error");
    scene.text += "# changed\n";
    EXPECT_THAT(message(versions), HasSubstr("holds results of another scene"));
    sample::write(path / "scene.toml", scene.text);
    EXPECT_THAT(message(versions), HasSubstr("results.sqlite.part: holds results of another scene (hash "));
}

TEST_F(SweepStoreTest, TwoRunsInOneFolderAreRefused) {
    SweepStore store(path, scene, versions, Mode::fresh);
    for (const Mode mode : {Mode::fresh, Mode::resume}) {
        EXPECT_THAT(error_of([&] { SweepStore(path, scene, versions, mode); }), HasSubstr("in use by another process"));
    }
    (void)work(store, 2);
}

TEST_F(SweepStoreTest, ADamagedStoreIsOneLine) {
    sample::write(path / "results.sqlite.part", "this is not a database, though it is long enough to be looked at\n");
    const std::string message = error_of([&] { SweepStore(path, scene, versions, Mode::resume); });
    EXPECT_THAT(message, HasSubstr("results.sqlite.part: cannot be"));
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_THAT(error_of([&] { SweepStore{path / "nothing"}; }),
                HasSubstr("expected the folder of a sweep, got nothing"));
    sample::write(path / "results.sqlite", "");
    EXPECT_THAT(error_of([&] { SweepStore{path}; }), HasSubstr("empty store"));
}

/// A file-size limit fails writes as a full disk does.
class SizeLimit {
public:
    explicit SizeLimit(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~SizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

TEST_F(SweepStoreTest, NoRoomLeftIsOneLineAndTheStoreStaysValid) {
    (void)whole(path / "whole");
    {
        SweepStore store(path / "out", scene, versions, Mode::fresh);
        (void)work(store, 3);
        const SizeLimit limit(std::filesystem::file_size(path / "out" / "results.sqlite.part-wal"));
        const std::string message = error_of([&] { (void)work(store); });
        EXPECT_THAT(message, HasSubstr("results.sqlite.part: cannot be written: "));
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    SweepStore store(path / "out", scene, versions, Mode::resume);
    int kept = 0;
    store.for_each([&kept](const WorkResult&) { ++kept; });
    EXPECT_GE(kept, 3);
    EXPECT_TRUE(work(store));
    store.finish();
    (void)export_sweep(store, path / "out");
    expect_same_tables(path / "out", path / "whole");
}

TEST_F(SweepStoreTest, ReadsBackForCharts) {
    (void)whole(path);
    for (const char* file : sweep_files) std::filesystem::remove(path / file);
    const StoredSweep stored = read_sweep_folder(path);
    EXPECT_EQ(stored.scene.title, "A sample");
    EXPECT_EQ(stored.patterns.size(), 4U);
    EXPECT_EQ(stored.levels.size() % 4, 0U);
    EXPECT_FALSE(stored.orbits.empty());
}

TEST_F(SweepStoreTest, ReadsBackWhatWasWritten) {
    const Scene mode = parse_scene(sample::scene_text, "sample");
    sample::store(path / "out", mode, sample::results_of(mode));
    const StoredSweep stored = read_sweep_folder(path / "out");
    EXPECT_EQ(stored.scene.title, "A sample");
    ASSERT_EQ(stored.patterns.size(), 19U);
    ASSERT_EQ(stored.levels.size(), 19U);
    ASSERT_EQ(stored.orbits.size(), 19U);
    for (std::size_t i = 0; i < stored.orbits.size(); ++i) {
        const OrbitAnswer answer = sample::least_energy_answer(mode.bar, stored.patterns[i].pattern);
        EXPECT_EQ(stored.patterns[i].interval.least, answer.interval.least);
        EXPECT_EQ(stored.patterns[i].verdict, Verdict::admissible);
        EXPECT_EQ(stored.levels[i].energy, answer.energy);
        EXPECT_FALSE(stored.levels[i].level.has_value());
        EXPECT_EQ(stored.orbits[i].orbit.beta, answer.orbit->beta);
    }
}

TEST(OpenTime, IsToldWhereItIsMostOfALongTime) {
    EXPECT_EQ(open_time_text({52, 41, 12}, 8),
              "most of the time (41 of 52 s) went to 12 levels that stayed unproved: free patterns have many local "
              "optima; --starts 2 spends less on them, and may miss better orbits");
    EXPECT_THAT(open_time_text({52, 41, 12}, 1), testing::EndsWith("many local optima"));
    EXPECT_EQ(open_time_text({52, 26, 12}, 8), "");
    EXPECT_EQ(open_time_text({9, 9, 12}, 8), "");
    EXPECT_EQ(open_time_text({}, 8), "");
}

TEST_F(SweepStoreTest, AnInterruptedSweepLeavesWhatItHas) {
    SweepStore store(path, scene, versions, Mode::fresh);
    EXPECT_FALSE(work(store, 3));
    for (int time = 0; time < 2; ++time)
        EXPECT_THAT(export_sweep(store, path).line, HasSubstr("partial results are in"));
    EXPECT_THAT(sample::read(path / "summary.txt"), HasSubstr("interrupted"));
}

/// What a store that was tampered with leads to: the tables, or the message that refuses it.
struct Outcome {
    std::string tables;
    std::string message;
};

class DamagedStore : public SweepStoreTest {
protected:
    [[nodiscard]] std::string tables(const std::filesystem::path& folder) const {
        std::string all;
        for (const char* name : {"patterns.csv", "levels.csv", "orbits.jsonl", "timings.csv", "summary.json"})
            all += sample::read(folder / name);
        return all;
    }
    /// Exports a store; of a part file after going on with it.
    [[nodiscard]] Outcome outcome(const std::filesystem::path& folder, bool part) {
        Outcome result;
        result.message = error_of([&] {
            if (part) {
                SweepStore store(folder, scene, versions, Mode::resume);
                if (work(store)) store.finish();
            }
            SweepStore store(folder);
            (void)export_sweep(store, folder, false);
        });
        result.tables = tables(folder);
        return result;
    }
    void expect_refused(const std::string& message) const {
        EXPECT_THAT(message, HasSubstr("results.sqlite"));
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
};

TEST_F(DamagedStore, EveryChangedValueOfEveryColumnIsRefused) {
    (void)whole(path / "whole");
    const std::filesystem::path file = path / "whole" / "results.sqlite";
    const std::string sound = sample::read(file);
    std::vector<std::pair<std::string, std::string>> columns;
    {
        SQLite::Database database(file);
        SQLite::Statement query(database,
                                "SELECT m.name, c.name FROM sqlite_master m JOIN pragma_table_info(m.name) c"
                                " WHERE m.type = 'table'");
        while (query.executeStep())
            columns.emplace_back(query.getColumn(0).getString(), query.getColumn(1).getString());
    }
    ASSERT_GT(columns.size(), 60U);
    for (const auto& [table, column] : columns) {
        for (const std::string change : {"'other'", "7777", "NULL", "7.5"}) {
            SCOPED_TRACE(table + "." + column + " = " + change);
            sample::write(file, sound);
            int changed = 0;
            try {
                SQLite::Database database(file, SQLite::OPEN_READWRITE);
                // Its own value again changes nothing.
                changed = database.exec("UPDATE " + table + " SET " + column + " = " + change + " WHERE " + column +
                                        " IS NOT " + change + " AND " + column + " = (SELECT max(" + column +
                                        ") FROM " + table + ")");
            } catch (const SQLite::Exception&) {
                continue;  // two rows of one key
            }
            if (changed == 0) continue;
            const Outcome damaged = outcome(path / "whole", false);
            EXPECT_NE(damaged.message, "no error");
            expect_refused(damaged.message);
        }
    }
    for (const std::string key :
         {"format", "scene", "scene_hash", "title", "software", "options", "kinds", "complete", "results", "seconds"}) {
        for (const std::string change : {"UPDATE sweep SET value = '1' || value", "DELETE FROM sweep"}) {
            SCOPED_TRACE(change + " " + key);
            sample::write(file, sound);
            ASSERT_EQ(SQLite::Database(file, SQLite::OPEN_READWRITE).exec(change + " WHERE key = '" + key + "'"), 1);
            expect_refused(outcome(path / "whole", false).message);
        }
    }
}

TEST_F(DamagedStore, OtherTablesAndRowsOfNobodyAreRefused) {
    (void)whole(path / "whole");
    const std::filesystem::path file = path / "whole" / "results.sqlite";
    const std::string sound = sample::read(file);
    const std::vector<std::pair<std::string, std::string>> changes{
        {"DROP TABLE answers; CREATE TABLE answers(pattern, place); INSERT INTO answers VALUES(0, 0)", "table answers"},
        {"DROP TABLE patterns; CREATE TABLE patterns(number); INSERT INTO patterns VALUES(0)", "table patterns"},
        {"DROP TABLE orbits", "table orbits: is missing"},
        {"DROP TABLE sweep", "empty store"},
        {"DROP VIEW timings", "table timings"},
        {"ALTER TABLE solves ADD COLUMN more", "table solves: has other columns"},
        {"INSERT INTO orbits VALUES (99, 99, '[1]')", "orbits"},
        {"INSERT INTO solves (pattern, place, run) VALUES (99, 99, 0)", "solves"},
        {"UPDATE answers SET pattern = 99 WHERE pattern = 0", "answers"}};
    for (const auto& [change, named] : changes) {
        SCOPED_TRACE(change);
        sample::write(file, sound);
        SQLite::Database(file, SQLite::OPEN_READWRITE).exec(change);
        const std::string message = outcome(path / "whole", false).message;
        expect_refused(message);
        EXPECT_THAT(message, HasSubstr(named));
    }
}

TEST_F(DamagedStore, LostRowsAreMissed) {
    (void)whole(path / "whole");
    const std::filesystem::path file = path / "whole" / "results.sqlite";
    const std::string sound = sample::read(file);
    for (const std::string table : {"patterns", "answers", "solves", "orbits"}) {
        for (const std::string which : {"min", "max"}) {
            SCOPED_TRACE(table + " " + which);
            sample::write(file, sound);
            const int lost =
                SQLite::Database(file, SQLite::OPEN_READWRITE)
                    .exec("DELETE FROM " + table + " WHERE rowid = (SELECT " + which + "(rowid) FROM " + table + ")");
            if (lost == 0) continue;  // closed forms need no solver
            expect_refused(outcome(path / "whole", false).message);
        }
    }
}

TEST_F(DamagedStore, FlippedAndLostBytesNeverGiveOtherTables) {
    // Of complete results and of a part file that is gone on with: either they are refused in one line, or nothing that
    // counts was hit and the tables are the same.
    (void)whole(path / "whole");
    const Outcome sound = outcome(path / "whole", false);
    ASSERT_EQ(sound.message, "no error");
    {
        SweepStore store(path / "part", scene, versions, Mode::fresh);
        (void)work(store, 6);
    }
    std::mt19937 random(13);
    int refused = 0;
    int harmless = 0;
    for (const bool part : {false, true}) {
        const std::string name = part ? "results.sqlite.part" : "results.sqlite";
        const std::string bytes = sample::read(path / (part ? "part" : "whole") / name);
        for (int i = 0; i < 300; ++i) {
            SCOPED_TRACE(testing::Message() << name << " " << i);
            std::string damaged = bytes;
            const std::size_t at = random() % damaged.size();
            switch (i % 4) {
                case 0: damaged[at] = static_cast<char>(damaged[at] ^ (1 << random() % 8)); break;
                case 1:
                    for (std::size_t k = at; k < std::min(at + 16, damaged.size()); ++k)
                        damaged[k] = static_cast<char>(random());
                    break;
                case 2:
                    damaged.replace(at, 512, std::string(std::min<std::size_t>(512, damaged.size() - at), '\0'));
                    break;
                default: damaged.resize(at);
            }
            const std::filesystem::path folder = path / "damaged";
            std::filesystem::remove_all(folder);
            std::filesystem::create_directory(folder);
            sample::write(folder / "scene.toml", scene.text);
            sample::write(folder / name, damaged);
            const Outcome found = outcome(folder, part);
            if (found.message == "no error") {
                // Times of what is done anew are new.
                const auto of_results = [&](const std::filesystem::path& from) {
                    return sample::read(from / "patterns.csv") + sample::read(from / "levels.csv") +
                           sample::read(from / "orbits.jsonl");
                };
                EXPECT_EQ(of_results(folder), of_results(path / "whole"));
                if (!part) {
                    EXPECT_EQ(found.tables, sound.tables);
                }
                ++harmless;
            } else {
                expect_refused(found.message);
                ++refused;
            }
        }
    }
    RecordProperty("refused", refused);
    RecordProperty("harmless", harmless);
    EXPECT_GT(refused, 100);
}

TEST_F(SweepStoreTest, DamagedFoldersAreNamed) {
    const auto message = [&](const char* name) { return error_of([&] { (void)read_sweep_folder(path / name); }); };
    EXPECT_THAT(message("nothing"), HasSubstr("got nothing"));
    sample::write(path / "file", "text");
    EXPECT_THAT(message("file"), HasSubstr("got a file"));
    std::filesystem::create_directory(path / "empty");
    EXPECT_THAT(message("empty"), HasSubstr("without results.sqlite"));
    (void)whole(path / "damaged");
    SQLite::Database(path / "damaged" / "results.sqlite", SQLite::OPEN_READWRITE)
        .exec("UPDATE orbits SET beta = '[1, x]'");
    EXPECT_THAT(message("damaged"), HasSubstr("results.sqlite: is damaged: table answers, pattern 0, place 0: "));
    EXPECT_EQ(message("damaged").find('\n'), std::string::npos);
    SQLite::Database(path / "damaged" / "results.sqlite", SQLite::OPEN_READWRITE)
        .exec("UPDATE patterns SET verdict = 'splendid'");
    EXPECT_THAT(message("damaged"), HasSubstr("results.sqlite: is damaged: table patterns, number 0: "));
}

}  // namespace
}  // namespace nsma
