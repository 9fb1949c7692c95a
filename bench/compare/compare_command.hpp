// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace apsl::compare {

struct CompareOptions {
    std::vector<std::filesystem::path> scenes;
    std::vector<std::string> methods;
    std::optional<std::filesystem::path> study;
    std::vector<std::string> overrides;
    std::optional<int> frames;
    std::optional<int> device;
    bool measure_deviation = false;
    std::vector<int> deviation_frames;
    std::optional<double> run_seconds;
    std::optional<int> rounds;
    bool profile = false;
    std::filesystem::path out;
};

/// Scenes × methods × parameters, one run after the other, each in the results as soon as it is done. Exit codes and
/// exceptions as in run/commands.hpp; a method that diverges or runs out of time is a result.
int compare_command(const CompareOptions& options);

}  // namespace apsl::compare
