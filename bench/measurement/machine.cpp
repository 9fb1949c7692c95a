// SPDX-License-Identifier: MIT
#include "measurement/machine.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

namespace apsl::bench {
namespace {

std::string output_of(const char* command) {
    struct Close {
        void operator()(FILE* pipe) const { pclose(pipe); }
    };
    const std::unique_ptr<FILE, Close> pipe(popen(command, "r"));
    std::string output;
    std::array<char, 256> line{};
    while (pipe && std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr) output += line.data();
    while (!output.empty() && output.back() == '\n') output.pop_back();
    return output;
}

}  // namespace

std::string commit() {
    if (const char* told = std::getenv("APSL_COMMIT"); told && *told) return told;
    const std::string revision = output_of("git -C '" APSL_SOURCE_DIRECTORY "' rev-parse --short=12 HEAD 2>/dev/null");
    if (revision.empty()) return "unknown";
    // What is measured lies in docs/ and changes from the first file on.
    const bool changed =
        !output_of("git -C '" APSL_SOURCE_DIRECTORY
                   "' status --porcelain --untracked-files=no -- ':/' ':(exclude,top)docs' 2>/dev/null")
             .empty();
    return changed ? revision + "-dirty" : revision;
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

}  // namespace apsl::bench
