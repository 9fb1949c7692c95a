// SPDX-License-Identifier: MIT
#include "embed/binary_snippet.hpp"
#include "embed/without_binaries.hpp"
#include "support/device_cloth.hpp"

#include <unistd.h>
#include <catch2/catch.hpp>
#include <fstream>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("docs/embedding.md's snippet keeps the program in a file and starts from it", "[embed]") {
    if (without_binaries()) return;
    const MovingCloth cloth = moving_cloth(tetrahedron(), 1);
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("apsl_program_binary_" + std::to_string(getpid()));
    std::filesystem::remove(path);
    const auto next_start = [&] { return start(device().context, device().id, cloth.topology, path); };

    const StrainLimiter first = next_start();
    CHECK(first.program_binary_use() == ProgramBinaryUse::none_given);
    keep_program(first, path);
    const StrainLimiter second = next_start();
    CHECK(second.program_binary_use() == ProgramBinaryUse::taken);

    // A start that was interrupted while writing: the next one builds from source and writes the file again.
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    const StrainLimiter third = next_start();
    CHECK(third.program_binary_use() == ProgramBinaryUse::damaged);
    keep_program(third, path);
    CHECK(next_start().program_binary_use() == ProgramBinaryUse::taken);
    std::filesystem::remove(path);
}
