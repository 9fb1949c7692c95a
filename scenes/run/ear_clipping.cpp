// SPDX-License-Identifier: MIT
#include "run/ear_clipping.hpp"

#include "pipeline/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace apsl::scenes {
namespace {

using Point = Eigen::Vector2d;

/// Least sin of an ear's sharpest corner, about, and how far other vertices stay away from it, in units of the polygon.
struct Demand {
    double shape;
    double clearance;
};
// Ears with a good shape first: what is left at last may be as thin as the polygon.
constexpr std::array demands{Demand{1e-3, 1e-9}, Demand{1e-6, 1e-12}, Demand{1e-9, 1e-15}, Demand{0.0, 0.0}};
// Of a fan, which is kept where it is fit for use.
constexpr double fan_shape = 1e-6;
constexpr std::size_t most_tests = 100'000'000;

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Twice the area over the square of the longest edge; 0 or less where it is not counter-clockwise.
double shape(const Point& a, const Point& b, const Point& c) {
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0.0 ? cross(a, b, c) / longest : 0.0;
}

// Along the polygon's area vector, relative to its first vertex, in units of its extent; empty without an area.
std::vector<Point> project(std::span<const double> positions, std::span<const std::uint32_t> polygon) {
    const Eigen::Vector3d origin = vector_at(positions, polygon[0]);
    double extent = 0.0;
    for (const std::uint32_t v : polygon)
        extent = std::max(extent, (vector_at(positions, v) - origin).lpNorm<Eigen::Infinity>());
    if (!(extent > 0.0) || !std::isfinite(extent)) return {};
    const auto offset = [&](std::uint32_t v) -> Eigen::Vector3d { return (vector_at(positions, v) - origin) / extent; };
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) normal += offset(polygon[k]).cross(offset(polygon[k + 1]));
    if (!(normal.norm() > 0.0)) return {};
    normal.normalize();
    // Across the axis that the normal leans to least: axes stay axes in their own planes.
    Eigen::Index axis = 0;
    normal.cwiseAbs().minCoeff(&axis);
    const Eigen::Vector3d along = (Eigen::Vector3d::Unit(axis) - normal[axis] * normal).normalized();
    const Eigen::Vector3d across = normal.cross(along);
    std::vector<Point> points;
    points.reserve(polygon.size());
    for (const std::uint32_t v : polygon) points.emplace_back(along.dot(offset(v)), across.dot(offset(v)));
    return points;
}

/// The part of the polygon that is not cut off yet, as a ring of corners.
class Ring {
public:
    explicit Ring(std::vector<Point> points)
        : points_(std::move(points)), next_(points_.size()), previous_(points_.size()), left_(points_.size()) {
        std::iota(next_.begin(), next_.end(), std::size_t{1});
        next_.back() = 0;
        std::iota(previous_.begin(), previous_.end(), std::size_t{0} - 1);
        previous_.front() = points_.size() - 1;
        // A corner inside of an ear means one that is not convex inside of it, and corners only become sharper.
        for (std::size_t k = 0; k < points_.size(); ++k)
            if (shape(points_[previous_[k]], points_[k], points_[next_[k]]) < fan_shape) blocking_.push_back(k);
    }

    std::size_t left() const { return left_; }
    std::size_t next(std::size_t corner) const { return next_[corner]; }
    std::array<std::size_t, 3> triangle(std::size_t corner) const { return {previous_[corner], corner, next_[corner]}; }

    bool is_ear(std::size_t corner, const Demand& demand) {
        const auto [before, here, after] = triangle(corner);
        const Point &a = points_[before], &b = points_[here], &c = points_[after];
        const double found = shape(a, b, c);
        if (!(found > 0.0) || found < demand.shape) return false;
        const Point low = a.cwiseMin(b).cwiseMin(c).array() - demand.clearance;
        const Point high = a.cwiseMax(b).cwiseMax(c).array() + demand.clearance;
        for (const std::size_t k : blocking_) {
            const Point& p = points_[k];
            if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) continue;
            if (cut_off(k) || p == a || p == b || p == c) continue;
            if (cross(a, b, p) >= -demand.clearance && cross(b, c, p) >= -demand.clearance &&
                cross(c, a, p) >= -demand.clearance)
                return false;
        }
        return true;
    }
    std::size_t tests_of_an_ear() const { return blocking_.size() + 1; }

    void cut_off_ear(std::size_t corner) {
        next_[previous_[corner]] = next_[corner];
        previous_[next_[corner]] = previous_[corner];
        previous_[corner] = corner;
        --left_;
    }

private:
    bool cut_off(std::size_t corner) const { return previous_[corner] == corner; }

    std::vector<Point> points_;
    std::vector<std::size_t> next_, previous_;
    std::vector<std::size_t> blocking_;
    std::size_t left_;
};

void add_triangle(std::span<const std::uint32_t> polygon, const std::array<std::size_t, 3>& corners,
                  std::vector<Triangle>& triangles) {
    triangles.push_back({polygon[corners[0]], polygon[corners[1]], polygon[corners[2]]});
}

PolygonCut clip_ears(Ring ring, std::span<const std::uint32_t> polygon, std::vector<Triangle>& triangles) {
    std::size_t corner = 0;
    std::size_t tests = 0;
    while (ring.left() > 2) {
        bool found = false;
        for (const Demand& demand : demands) {
            for (std::size_t tried = 0; tried < ring.left() && !found; ++tried) {
                if ((tests += ring.tests_of_an_ear()) > most_tests) return PolygonCut::too_long;
                found = ring.is_ear(corner, demand);
                if (!found) corner = ring.next(corner);
            }
            if (found) break;
        }
        if (!found) return PolygonCut::crossing;
        add_triangle(polygon, ring.triangle(corner), triangles);
        const std::size_t after = ring.next(corner);
        ring.cut_off_ear(corner);
        corner = ring.next(after);  // not the neighbour again, so that not all ears lie at one vertex
    }
    return PolygonCut::exact;
}

bool fan_is_fit(const std::vector<Point>& points) {
    for (std::size_t k = 1; k + 1 < points.size(); ++k)
        if (!(shape(points[0], points[k], points[k + 1]) > fan_shape)) return false;
    return !points.empty();
}

}  // namespace

PolygonCut cut_polygon(std::span<const double> positions, std::span<const std::uint32_t> polygon,
                       std::vector<Triangle>& triangles) {
    PolygonCut cut = PolygonCut::exact;
    if (polygon.size() > 3) {
        std::vector<Point> points = project(positions, polygon);
        if (!fan_is_fit(points)) {
            const std::size_t before = triangles.size();
            cut = points.empty() ? PolygonCut::crossing : clip_ears(Ring(std::move(points)), polygon, triangles);
            if (cut == PolygonCut::exact) return cut;
            triangles.resize(before);
            if (cut == PolygonCut::too_long) return cut;
        }
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) add_triangle(polygon, {0, k, k + 1}, triangles);
    return cut;
}

}  // namespace apsl::scenes
