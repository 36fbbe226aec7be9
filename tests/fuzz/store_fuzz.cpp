// A sound store, damaged as the input says: refused in one line that names the file, or the same tables as before.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

#include "../support/sweep_scene.hpp"
#include "fuzz.hpp"

#include "study/sweep/sweep_queue.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/sweep/sweep_export.hpp"

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

struct Sound {
    fs::path folder = fs::temp_directory_path() / ("nsma-fuzz-" + std::to_string(getpid()));
    std::string store, tables;

    Sound() {
        fs::create_directories(folder);
        const nsma::Scene scene = nsma::parse_scene(sweep_scene_text, "sample");
        {
            nsma::SweepStore made(folder, scene, {"nsma", "solver proof"}, nsma::SweepStore::Mode::fresh);
            nsma::SweepQueue queue(scene, {}, nsma::SweepQueue::Order::scene);
            nsma::SweepWorker worker(scene, {});
            while (!queue.finished()) {
                const auto results = worker.run(queue.next(0));
                made.put(results);
                for (const auto& result : results) queue.done(result);
            }
            made.finish();
        }
        store = contents(folder / "results.sqlite");
        tables = exported();
    }
    ~Sound() { fs::remove_all(folder); }

    [[nodiscard]] std::string exported() const {
        const nsma::SweepStore opened(folder);
        (void)nsma::export_sweep(opened, folder);
        std::string all;
        for (const char* name : {"patterns.csv", "levels.csv", "orbits.jsonl", "timings.csv", "summary.json"})
            all += contents(folder / name);
        return all;
    }
};

const Sound& sound() {
    static const Sound made;
    return made;
}

// Pieces of six bytes: where (3), what (1), with what (2).
std::string damaged(std::string store, const std::uint8_t* data, std::size_t size) {
    for (; size >= 6 && !store.empty(); data += 6, size -= 6) {
        const std::size_t at = (data[0] * 65536U + data[1] * 256U + data[2]) % store.size();
        const std::size_t more = std::min<std::size_t>(1 + data[5], store.size() - at);
        switch (data[3] % 5) {
            case 0: store[at] = static_cast<char>(store[at] ^ (1 << data[4] % 8)); break;
            case 1: store[at] = static_cast<char>(data[4]); break;
            case 2: store.replace(at, more, std::string(more, static_cast<char>(data[4]))); break;
            case 3: store.erase(at, more); break;
            default: store.resize(at);
        }
    }
    return store;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const Sound& was = sound();
    std::ofstream(was.folder / "results.sqlite", std::ios::binary) << damaged(was.store, data, size);
    try {
        fuzz::expect(was.exported() == was.tables, "what is not refused gives the same tables");
    } catch (const nsma::InputError& error) {
        fuzz::expect_one_line(error.what());
        fuzz::expect(std::string_view(error.what()).find(was.folder.string()) != std::string_view::npos,
                     "a refusal names the file", error.what());
    }
    return 0;
}
