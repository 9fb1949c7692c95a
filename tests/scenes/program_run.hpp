// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace apsl::test {

struct ProgramRun {
    int exit_code = 0;
    std::string output;  ///< stdout
    std::string errors;  ///< stderr
};

/// Runs the program `apsl` through the shell. `environment`: assignments in front of it.
ProgramRun run_apsl(const std::string& arguments, const std::string& environment = "");

/// A scene of the project, "curtain.json".
std::string scene_path(const std::string& name);

}  // namespace apsl::test
