// Any bytes as a scene file: refused in one line, or a scene that can be used.
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "fuzz.hpp"

#include "nsma/report/scene_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const nsma::Scene scene = nsma::parse_scene({reinterpret_cast<const char*>(data), size}, "input");
        nsma::validate(scene.bar);
        nsma::validate(scene.mesh);
        fuzz::expect(!scene.levels.empty(), "a scene has levels");
        for (const double level : scene.levels)
            fuzz::expect(level > 0 && std::isfinite(level), "levels are numbers > 0");
        try {
            nsma::expect_feasible(scene);
        } catch (const std::invalid_argument& error) {
            fuzz::expect_one_line(error.what());
        }
    } catch (const nsma::InputError& error) {
        fuzz::expect_one_line(error.what());
    }
    return 0;
}
