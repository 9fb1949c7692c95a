// SPDX-License-Identifier: MIT
#include "filter/filtered.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

namespace {

// Small enough for an interpreter that watches every access: oclgrind.cmake runs those tagged [oclgrind] in one.
void check_variants(std::uint32_t work_group_size) {
    const MovingCloth cloth = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    const Parameters parameters{.regularization = 1.3f, .sub_steps = 2, .tolerance = 1e-2f, .max_iterations = 12};
    const auto check = [&](Options options) {
        options.work_group_size = work_group_size;
        CAPTURE(variant_name(options));
        check_against_reference(cloth, options, parameters);
    };
    for (const Options& options : variants) check(options);
    check(by_chebyshev);
}

}  // namespace

TEST_CASE("every variant on a small grid in groups of 1, for a memory checker", "[filter][oclgrind]") {
    check_variants(1);
}

TEST_CASE("every variant on a small grid in groups of 32, for a memory checker", "[filter][oclgrind][scalar]") {
    check_variants(32);
}

TEST_CASE("every variant on a small grid in groups of 2, over which a compiler may crash", "[filter]") {
    check_variants(2);
}
