// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace apsl::scenes {

/// Of TuneOptions::target_stretch: the least stretch ceiling.
inline constexpr double least_target_stretch = 1.01;

struct TuneOptions {
    std::filesystem::path scene;
    double target = 0.01;  ///< greatest |A − A⁰| / A⁰
    /// Greatest principal stretch; without one the scene's stretch ceiling says it, where it has one.
    std::optional<double> target_stretch;
    std::optional<double> budget_ms;  ///< of the limiter, a frame
    std::optional<int> device;
    std::optional<int> frames;
    std::vector<std::string> overrides;
    std::optional<std::filesystem::path> out;  ///< stdout without
};

/// Finds the cheapest settings of the limiter that meet the target and writes the scene with them; prints what was
/// tried, and which stages the scene could do without. Exit code exit_broke_down where nothing met the target (the best
/// is written all the same), else as in commands.hpp. The scene and its mesh are never overwritten.
int tune_command(const TuneOptions& options);

}  // namespace apsl::scenes
