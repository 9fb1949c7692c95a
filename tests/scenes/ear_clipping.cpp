// SPDX-License-Identifier: MIT
#include "run/ear_clipping.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

using namespace apsl;
using namespace apsl::scenes;

namespace {

struct Outline {
    std::string name;
    std::vector<Eigen::Vector2d> corners;  // counter-clockwise
};

// Teeth 1 wide and 3 high on a bar 1 high.
Outline comb(int teeth) {
    Outline outline{"comb of " + std::to_string(teeth), {{0.0, 0.0}, {2.0 * teeth - 1.0, 0.0}}};
    for (int k = teeth - 1; k >= 0; --k) {
        outline.corners.insert(outline.corners.end(), {{2.0 * k + 1.0, 4.0}, {2.0 * k, 4.0}});
        if (k > 0) outline.corners.insert(outline.corners.end(), {{2.0 * k, 1.0}, {2.0 * k - 1.0, 1.0}});
    }
    return outline;
}

Outline star(int points) {
    Outline outline{"star of " + std::to_string(points), {}};
    for (int k = 0; k < 2 * points; ++k) {
        const double angle = std::numbers::pi * k / points;
        outline.corners.emplace_back((k % 2 == 0 ? 0.3 : 1.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return outline;
}

// A band that winds inwards three times.
Outline spiral() {
    Outline outline{"spiral", {}};
    std::vector<Eigen::Vector2d> inner;
    for (int k = 0; k <= 90; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 30.0;
        const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
        outline.corners.emplace_back((4.0 - angle / 8.0) * direction);
        inner.emplace_back((3.5 - angle / 8.0) * direction);
    }
    outline.corners.insert(outline.corners.end(), inner.rbegin(), inner.rend());
    return outline;
}

std::vector<Outline> outlines() {
    return {
        {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}},
        {"dart", {{4, 0}, {1, 1}, {0, 4}, {0, 0}}},
        {"arrow head", {{0, 0}, {2, 1}, {0, 2}, {1.999, 1}}},
        {"L", {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}},
        {"U", {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}},
        comb(2),
        comb(40),
        star(5),
        star(101),
        spiral(),
        {"collinear on every side",
         {{0, 0}, {0.1, 0}, {0.2, 0}, {0.3, 0}, {0.3, 0.1}, {0.3, 0.3}, {0.2, 0.3}, {0, 0.3}, {0, 0.1}}},
        {"triangle with a vertex on each side", {{0, 0}, {1, 0}, {2, 0}, {1.5, 1}, {1, 2}, {0.5, 1}}},
        {"collinear in a notch", {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 3}, {2, 2}, {2, 1}, {1, 1}, {1, 4}, {0, 4}}},
        {"needle", {{0, 0}, {1, 0}, {2, 1e-7}, {1, 2e-7}, {0, 1e-7}}},
        {"needle with a notch", {{0, 0}, {2, 0}, {2, 1e-7}, {1, 0.5e-7}, {0, 1e-7}}},
        {"hole, by a bridge", {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}},
    };
}

std::vector<Triangle> cut(const std::vector<Eigen::Vector3d>& corners, PolygonCut expected) {
    std::vector<double> positions;
    for (const Eigen::Vector3d& corner : corners) positions.insert(positions.end(), corner.begin(), corner.end());
    std::vector<std::uint32_t> polygon(corners.size());
    std::iota(polygon.begin(), polygon.end(), 0u);
    std::vector<Triangle> triangles;
    CHECK(cut_polygon(positions, polygon, triangles) == expected);
    return triangles;
}

// m², along the normal.
Eigen::Vector3d area(const std::vector<Eigen::Vector3d>& corners, const Triangle& t) {
    return 0.5 * (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]);
}

}  // namespace

TEST_CASE("polygons of every shape are covered once, in any plane, from any first vertex") {
    const Outline outline = GENERATE(from_range(outlines()));
    const auto [axis_x, axis_y, angle] = GENERATE(table<double, double, double>(
        {{1, 0, 0.0}, {1, 0, 90.0}, {0, 1, -90.0}, {1, 0, 180.0}, {2, 3, 70.0}, {1, -4, 133.0}}));
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle * std::numbers::pi / 180.0, Eigen::Vector3d(axis_x, axis_y, 0.0).normalized())
            .toRotationMatrix();
    CAPTURE(outline.name, angle);
    const std::size_t count = outline.corners.size();
    for (std::size_t first = 0; first < std::min<std::size_t>(count, 12); ++first) {
        CAPTURE(first);
        std::vector<Eigen::Vector3d> corners;
        double whole = 0.0;  // m², by the shoelace formula
        for (std::size_t k = 0; k < count; ++k) {
            const Eigen::Vector2d& p = outline.corners[(first + k) % count];
            const Eigen::Vector2d& q = outline.corners[(first + k + 1) % count];
            whole += 0.5 * (p.x() * q.y() - q.x() * p.y());
            corners.emplace_back(turn * Eigen::Vector3d(p.x(), p.y(), 0.0) + Eigen::Vector3d(1.0, -2.0, 3.0));
        }
        // As many as a polygon can have, all on the same side: their sum is how often each point is covered.
        const std::vector<Triangle> triangles = cut(corners, PolygonCut::exact);
        CHECK(triangles.size() == count - 2);
        double sum = 0.0;
        double least = whole;
        std::vector<bool> used(count, false);
        for (const Triangle& t : triangles) {
            const double part = area(corners, t).dot(turn.col(2));
            sum += part;
            least = std::min(least, part);
            for (const std::uint32_t v : t) used[v] = true;
        }
        CHECK(sum == Approx(whole).epsilon(1e-8));
        CHECK(least > 1e-7 * whole);
        CHECK(std::count(used.begin(), used.end(), true) == static_cast<std::ptrdiff_t>(count));
    }
}

TEST_CASE("a polygon that is not planar is cut as seen along its area vector") {
    // A dart whose inner corner is lifted, and an octagon that waves.
    const std::vector<Eigen::Vector3d> dart{{4, 0, 0}, {1, 1, 0.8}, {0, 4, 0}, {0, 0, 0}};
    CHECK(cut(dart, PolygonCut::exact) == std::vector<Triangle>{{3, 0, 1}, {1, 2, 3}});
    std::vector<Eigen::Vector3d> wave;
    for (int k = 0; k < 8; ++k)
        wave.emplace_back(std::cos(k * std::numbers::pi / 4.0), std::sin(k * std::numbers::pi / 4.0), k % 2 * 0.5);
    CHECK(cut(wave, PolygonCut::exact).size() == 6);
}

TEST_CASE("a convex polygon is a fan from its first vertex, and a triangle stays as it is") {
    CHECK(cut({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}}, PolygonCut::exact) ==
          std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
    CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, PolygonCut::exact) == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("a polygon that crosses or pinches itself or has no area is a fan, and said to be one") {
    const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}};
    CHECK(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, PolygonCut::crossing) == fan);
    CHECK(cut({{0, 0, 0}, {4, 4, 0}, {3, 0, 0}, {0, 1, 0}}, PolygonCut::crossing) == fan);
    CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, PolygonCut::crossing) == fan);
    CHECK(cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, PolygonCut::crossing) == fan);
    // Two squares that hang together by a point have two triangles each: eight corners would give six.
    CHECK(cut({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {4, 2, 0}, {4, 4, 0}, {2, 4, 0}, {2, 2, 0}, {0, 2, 0}},
              PolygonCut::crossing)
              .size() == 6);
    const double huge = 1e308;
    CHECK(cut({{-huge, -huge, 0}, {huge, -huge, 0}, {huge, huge, 0}, {-huge, huge, 0}}, PolygonCut::crossing) == fan);
}
