// SPDX-License-Identifier: MIT
#include "scenes/program_run.hpp"

#include "scenes/sample_files.hpp"

#include <sys/wait.h>

#include <cstdlib>

namespace apsl::test {

ProgramRun run_apsl(const std::string& arguments, const std::string& environment) {
    const TemporaryFolder folder;
    const std::string output = (folder.path() / "stdout").string();
    const std::string errors = (folder.path() / "stderr").string();
    const std::string command =
        environment + " " APSL_PROGRAM " " + arguments + " >" + output + " 2>" + errors + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(output), read_bytes(errors)};
}

std::string scene_path(const std::string& name) {
    return std::string(APSL_SCENES "/") + name;
}

}  // namespace apsl::test
