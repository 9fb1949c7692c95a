// SPDX-License-Identifier: MIT
#pragma once

#include "compare/compared_methods.hpp"
#include "compare/converged_solution.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace apsl::compare {

/// One method with every combination of its parameters' values that is to be run.
struct MethodRuns {
    const ComparedMethod* method;
    std::vector<ParameterValues> parameters;
};

/// Where the converged solution is made and looked at.
struct DeviationSettings {
    std::vector<int> frames;  ///< empty: ten, evenly spread, the last one among them
    ConvergedSettings converged;
};

/// Of Study::rounds.
constexpr int max_rounds = 1000;

/// What is to be compared: docs/study.schema.json.
struct Study {
    std::vector<SceneCase> scenes;
    std::vector<MethodRuns> methods;
    std::optional<DeviationSettings> deviation;
    std::optional<double> run_seconds;
    int rounds = 1;  ///< times that all runs are made, in turn
    bool keep_frames = false;
};

/// Reads a scene file as a case by the name of its file, changed by `overrides`. Throws InputError.
SceneCase read_scene_case(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// `overrides` change every scene after the study's own changes. Throws InputError naming file, place and what was
/// expected.
Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The methods by these names, all where there are none, each with its standard sweep. Throws InputError.
std::vector<MethodRuns> standard_methods(const std::vector<std::string>& names);

}  // namespace apsl::compare
