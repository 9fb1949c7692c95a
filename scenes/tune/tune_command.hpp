// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace apsl::scenes {

struct TuneOptions {
    std::filesystem::path scene;
    double target = 0.01;             ///< greatest |A − A⁰| / A⁰
    std::optional<double> budget_ms;  ///< of the limiter, a frame
    std::optional<int> device;
    std::optional<int> frames;
    std::vector<std::string> overrides;
    std::optional<std::filesystem::path> out;  ///< stdout without
};

/// Finds the cheapest settings of the limiter that meet the target and writes the scene with them; prints what was
/// tried, and which stages the scene could do without. Exit code exit_broke_down where nothing met the target (the best
/// is written all the same), else as in commands.hpp.
int tune_command(const TuneOptions& options);

}  // namespace apsl::scenes
