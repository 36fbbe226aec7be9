#pragma once

#include <atomic>

#include "command_line.hpp"
#include "nsma/study/scene.hpp"

namespace nsma::app {

enum ExitCode { exit_done = 0, exit_input = 2, exit_inadmissible = 3, exit_solver = 4, exit_interrupted = 130 };

/// Each runs one command and returns its exit code. `stop` turns true on Ctrl-C; long work then
/// ends after the solve in hand and keeps what it has. Throw InputError on bad input.
[[nodiscard]] int run(const ScanArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const OrbitArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const SweepArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const ExportArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const AccuracyArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const SensitivityArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const PlotArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const ProveArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const CheckArguments& arguments, const std::atomic<bool>& stop);
[[nodiscard]] int run(const TextArguments& arguments, const std::atomic<bool>& stop);

/// The scene of a file with the command line's changes, checked.
[[nodiscard]] Scene load_scene(const SceneArguments& arguments);

}  // namespace nsma::app
