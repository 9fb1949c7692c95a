// SPDX-License-Identifier: MIT
#include "filter/filtered.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

// Small enough for an interpreter that watches every access: oclgrind.cmake runs this test in one.
TEST_CASE("every variant on a small grid, for a memory checker", "[filter][oclgrind]") {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    const Parameters parameters{.regularization = 1.3f, .sub_steps = 2, .tolerance = 1e-2f, .max_iterations = 12};
    for (Options options : variants)
        for (const std::uint32_t work_group_size : {1u, 32u}) {
            options.work_group_size = work_group_size;
            CAPTURE(variant_name(options));
            check_against_reference(cloth, options, parameters);
        }
}
