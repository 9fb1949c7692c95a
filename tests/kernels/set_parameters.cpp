// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

TEST_CASE("set_parameters: writes the given entries of the block, and no others", "[set_parameters]") {
    const std::vector<Cloth> cloths(APSLK_PARAMETER_BLOCK + 6, make_cloth(right_triangle(), 1));
    apslk_parameter_block block{};
    for (int n = 0; n < APSLK_PARAMETER_BLOCK; ++n) {
        const float x = static_cast<float>(n);
        block.entry[n] = {0.1f + x, 10.0f - x, 1.0f + x, 0.01f * x, 1e-4f * x, n,       100 + n,
                          200 + n,  300 + n,   1,        n % 2,     1.0f + x,  400 + n, {x, 1.0f + x, 2.0f + x},
                          0.5f * x, 1e-3f * x, 1 + n,    500 + n,   {}};
    }
    for (const std::uint32_t group : work_group_sizes())
        for (const auto& [first, count] : {std::pair{0u, 1u}, {5u, 3u}, {6u, std::uint32_t{APSLK_PARAMETER_BLOCK}}}) {
            CAPTURE(group, first, count);
            Arrays arrays(cloths, Matrix::consistent, paper_setting, 1);
            std::vector<apslk_parameters> expected = poison<apslk_parameters>(cloths.size());
            arrays.parameters.write(expected);
            std::copy_n(block.entry, count, expected.begin() + first);
            launch::set_parameters(arrays, {.work_group_size = group}, block, first, count);
            CHECK(same_bytes(expected, arrays.parameters.read()));
        }
}
