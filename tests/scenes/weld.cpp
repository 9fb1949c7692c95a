// SPDX-License-Identifier: MIT
#include "run/weld.hpp"

#include "run/fixed_sequence.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace apsl::scenes;

namespace {

// Every vertex against every one before it.
std::vector<std::uint32_t> first_within_by_all(const std::vector<double>& positions, double distance) {
    std::vector<std::uint32_t> first;
    for (std::uint32_t v = 0; v < positions.size() / 3; ++v) {
        std::uint32_t found = v;
        for (std::uint32_t u = 0; u < v && found == v; ++u) {
            const double length =
                std::hypot(positions[3 * u] - positions[3 * v], positions[3 * u + 1] - positions[3 * v + 1],
                           positions[3 * u + 2] - positions[3 * v + 2]);
            if (first[u] == u && length <= distance) found = u;
        }
        first.push_back(found);
    }
    return first;
}

}  // namespace

TEST_CASE("weld: the first vertex within the distance is the one that comparing all with all finds") {
    const double distance = GENERATE(1e-9, 0.03, 0.2, 5.0);
    const double away = GENERATE(0.0, -1000.0);
    FixedSequence places;
    std::vector<double> positions;
    for (int k = 0; k < 3 * 600; ++k) positions.push_back(away + places.symmetric());
    positions.insert(positions.end(), positions.begin(), positions.begin() + 300);  // in the same places once more
    const std::vector<std::uint32_t> first = first_within(positions, distance);
    CHECK(first == first_within_by_all(positions, distance));
    CHECK(first[600] == first[0]);
}

TEST_CASE("weld: 0 and -0 are one place, and so are numbers too great for a grid") {
    CHECK(first_within(std::vector<double>{0, 0, 0, -0.0, -0.0, 0, 1e300, 0, 0, 1e300, 0, 0, 1e300, 1, 0}, 1e-12) ==
          std::vector<std::uint32_t>{0, 0, 2, 2, 4});
}
