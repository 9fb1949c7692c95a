// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace apsl::compare {

/// A scene to compare on, by a name that is its own in a file of results.
struct SceneCase {
    std::string name;
    std::string file;         ///< for messages, and what its mesh file is relative to
    nlohmann::json document;  ///< with all changes made
};

/// How the solution is made that others are held against: the scene in double precision with the reference limiter,
/// consistent matrix.
struct ConvergedSettings {
    int step_factor = 8;  ///< steps for each of the scene's
    int sub_steps = 60;   ///< at most
    double regularization = 1.01;
    double tolerance = 1e-6;
    double target_area_change = 1e-4;  ///< where sub-steps end
};
nlohmann::ordered_json to_json(const ConvergedSettings& settings);

struct ConvergedSolution {
    std::map<int, std::vector<double>> positions;  ///< m, [3V], at the end of a frame
    double max_area_change = 0.0;                  ///< over its steps: how far it is from all areas at rest
};

/// Reads it from `cache` where that holds the same scene, settings and frames; else runs it and leaves it there.
/// None where the run was interrupted. Throws InputError where it breaks down.
std::optional<ConvergedSolution> converged_solution(const SceneCase& scene, const ConvergedSettings& settings,
                                                    std::span<const int> frames, const std::filesystem::path& cache);

}  // namespace apsl::compare
