// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"

#include <apsl/error.hpp>
#include <apsl/tethers.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

struct Sheet {
    std::shared_ptr<const Topology> topology;
    std::vector<float> positions;

    explicit Sheet(const Mesh& mesh)
        : topology(Topology::build(mesh.triangles, mesh.vertex_count())),
          positions(mesh.positions.begin(), mesh.positions.end()) {}

    double distance(std::size_t a, std::size_t b) const {
        double squared = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            squared +=
                std::pow(static_cast<double>(positions[3 * a + k]) - static_cast<double>(positions[3 * b + k]), 2);
        return std::sqrt(squared);
    }
    Tethers tethers(const std::vector<std::uint32_t>& pinned, std::uint32_t per_vertex, float stretch = 1.0f) const {
        return tethers_to_pins(*topology, positions, pinned, per_vertex, stretch);
    }
};

}  // namespace

TEST_CASE("tethers: over a flat sheet the way is straight, whatever its diagonals", "[tethers]") {
    for (const Diagonals diagonals : {Diagonals::uniform, Diagonals::alternating, Diagonals::random}) {
        const Sheet sheet(grid(13, 9, 1.2, 0.8, diagonals));
        for (const std::uint32_t pin : {0u, 12u, 60u}) {
            const Tethers tethers = sheet.tethers({pin}, 1);
            REQUIRE(tethers.lengths.size() == 117);
            for (std::size_t v = 0; v < 117; ++v) {
                CAPTURE(static_cast<int>(diagonals), pin, v);
                CHECK(static_cast<double>(tethers.lengths[v]) == Approx(sheet.distance(v, pin)).epsilon(1e-6));
                if (v != pin) CHECK(tethers.anchors[v] == pin);
            }
        }
    }
}

TEST_CASE("tethers: folding a sheet changes no way", "[tethers]") {
    Sheet sheet(grid(13, 9, 1.2, 0.8, Diagonals::random));
    const Tethers flat = sheet.tethers({0, 12}, 2);
    // Along a column of the grid, so that no triangle bends.
    const float fold = sheet.positions[3 * 6];
    for (std::size_t v = 0; v < 117; ++v) {
        float* x = sheet.positions.data() + 3 * v;
        if (!(x[0] > fold)) continue;
        x[1] = x[0] - fold;
        x[0] = fold;
    }
    const Tethers folded = sheet.tethers({0, 12}, 2);
    CHECK(folded.anchors == flat.anchors);
    for (std::size_t t = 0; t < flat.lengths.size(); ++t) CHECK(folded.lengths[t] == Approx(flat.lengths[t]));
}

TEST_CASE("tethers: the way goes around a slit", "[tethers]") {
    // A square without its two middle columns of cells below the upper row: from one lower corner to the other over the
    // two inner corners of the gap.
    const Mesh whole = grid(7, 7, 6.0, 6.0, Diagonals::alternating);
    Mesh cut = whole;
    std::erase_if(cut.triangles, [&](const Triangle& triangle) {
        double x = 0.0, down = 0.0;
        for (const std::uint32_t v : triangle) {
            x += static_cast<double>(v % 7) / 3.0;
            down += static_cast<double>(v / 7) / 3.0;
        }
        return x > 2.0 && x < 4.0 && down > 1.0;
    });
    const Sheet sheet(cut);
    const double around = 2.0 * std::hypot(2.0, 5.0) + 2.0;
    // Beyond a corner the way is a little longer than the shortest.
    const auto length = static_cast<double>(sheet.tethers({42}, 1).lengths[48]);
    CHECK(length >= 0.999999 * around);
    CHECK(length <= 1.02 * around);
    CHECK(static_cast<double>(Sheet(whole).tethers({42}, 1).lengths[48]) == Approx(6.0));
}

TEST_CASE("tethers: one to each of the nearest pinned pieces, nearest first", "[tethers]") {
    const Sheet sheet(grid(9, 9, 1.0, 1.0, Diagonals::uniform));
    // Two corners, and three vertices of the lower edge, which are one piece.
    const std::vector<std::uint32_t> pinned{8, 0, 75, 76, 77};
    CHECK(pinned_piece_count(*sheet.topology, pinned) == 3);
    const Tethers tethers = sheet.tethers(pinned, 4, 1.1f);
    for (std::uint32_t v = 0; v < 81; ++v) {
        CAPTURE(v);
        const bool is_pinned = std::find(pinned.begin(), pinned.end(), v) != pinned.end();
        std::vector<double> lengths;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t t = 4 * v + k;
            const double length = static_cast<double>(tethers.lengths[t]);
            if (is_pinned || k == 3) {
                CHECK(length == 0.0);
                continue;
            }
            CHECK(length == Approx(1.1 * sheet.distance(v, tethers.anchors[t])).epsilon(0.1));
            CHECK(length >= 1.0999999 * sheet.distance(v, tethers.anchors[t]));
            if (!lengths.empty()) CHECK(length >= lengths.back());
            lengths.push_back(length);
        }
    }
    // Straight above the middle of the piece.
    CHECK(tethers.anchors[4 * 67] == 76);
    CHECK(static_cast<double>(tethers.lengths[4 * 67]) == Approx(1.1 / 8));
    // One alone: that of the nearest piece.
    CHECK(sheet.tethers(pinned, 1).anchors[67] == 76);
    CHECK(sheet.tethers(pinned, 1).anchors[1] == 0);
    CHECK(sheet.tethers(pinned, 1).anchors[7] == 8);
}

TEST_CASE("tethers: none where no pin is reached, and vertices in no triangle pin nothing", "[tethers]") {
    // Two triangles apart, and a seventh vertex.
    const Sheet sheet({.triangles = {{0, 1, 2}, {3, 4, 5}},
                       .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0, 9, 9, 9}});
    CHECK(pinned_piece_count(*sheet.topology, std::vector<std::uint32_t>{6}) == 0);
    CHECK(pinned_piece_count(*sheet.topology, {}) == 0);
    const Tethers tethers = sheet.tethers({0, 6}, 1, 2.0f);
    CHECK(tethers.lengths == std::vector<float>{0.0f, 2.0f, 2.0f, 0.0f, 0.0f, 0.0f, 0.0f});
    CHECK(sheet.tethers({}, 2).lengths == std::vector<float>(14, 0.0f));
}

TEST_CASE("tethers: what is refused", "[tethers]") {
    const Sheet sheet(grid(3, 3, 1.0, 1.0, Diagonals::uniform));
    CHECK_THROWS_WITH(sheet.tethers({9}, 1), "pinned vertex 9, expected one below 9");
    CHECK_THROWS_WITH(sheet.tethers({0}, 0), "per_vertex is 0, expected a whole number from 1 to 4");
    CHECK_THROWS_WITH(sheet.tethers({0}, 5), "per_vertex is 5, expected a whole number from 1 to 4");
    CHECK_THROWS_WITH(sheet.tethers({0}, 1, -1.0f), Catch::Contains("expected a finite number > 0"));
    CHECK_THROWS_WITH(sheet.tethers({0}, 1, std::numeric_limits<float>::infinity()),
                      Catch::Contains("expected a finite number > 0"));
    Sheet far = sheet;
    far.positions[0] = -3e38f;
    far.positions[3] = 3e38f;
    CHECK(far.tethers({0}, 1).lengths[1] == 0.0f);
    Sheet broken = sheet;
    broken.positions[4] = std::numeric_limits<float>::quiet_NaN();
    CHECK_THROWS_WITH(broken.tethers({0}, 1), "rest_positions of vertex 1 is not finite, expected finite numbers (m)");
    broken.positions.pop_back();
    CHECK_THROWS_WITH(broken.tethers({0}, 1), "rest_positions holds 26 numbers, expected 27");
}
