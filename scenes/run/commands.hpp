// SPDX-License-Identifier: MIT
#pragma once

#include "run/filter_stage.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace apsl::scenes {

// Of an interrupted command it is exit_code_of_interruption().
inline constexpr int exit_done = 0;
inline constexpr int exit_broke_down = 1;   ///< the simulation; the report says where
inline constexpr int exit_wrong_input = 2;  ///< usage, scene, mesh, device or output place; one line on stderr

struct RunOptions {
    std::filesystem::path scene;
    Backend backend = Backend::opencl;
    std::optional<int> device;
    std::optional<int> frames;
    std::optional<std::filesystem::path> out;
    std::optional<std::filesystem::path> report;
    std::vector<std::string> overrides;
    bool profile = false;
};

/// Each returns the exit code; wrong input is thrown as InputError or Error.
int run_command(const RunOptions& options);
int devices_command();
int validate_command(const std::filesystem::path& scene, const std::vector<std::string>& overrides);

}  // namespace apsl::scenes
