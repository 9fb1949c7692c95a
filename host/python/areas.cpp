// SPDX-License-Identifier: MIT
#include "areas.hpp"

#include "values.hpp"

#include <array>
#include <cmath>
#include <string>

namespace apsl::python {

namespace {

/// x₁ − x₀ and x₂ − x₀ of a triangle.
struct TwoEdges {
    std::array<double, 3> first, second;

    double doubled_area() const {
        const auto& [a, b] = *this;
        return std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    }
};

std::vector<TwoEdges> edges(py::handle positions, py::handle triangles) {
    const Array<double> points = vectors<double>(positions, "positions", std::nullopt);
    const std::vector<Triangle> corners = triangle_list(triangles);
    const auto at = points.unchecked<2>();
    std::vector<TwoEdges> all(corners.size());
    for (std::size_t t = 0; t < corners.size(); ++t) {
        const auto& [i, j, k] = corners[t];
        for (const std::uint32_t vertex : corners[t])
            if (vertex >= points.shape(0))
                refuse("triangles", "vertex " + std::to_string(vertex) + " in triangle " + std::to_string(t),
                       "0 to " + std::to_string(points.shape(0) - 1) + ", as there are so many positions");
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            all[t].first[axis] = at(j, axis) - at(i, axis);
            all[t].second[axis] = at(k, axis) - at(i, axis);
        }
    }
    return all;
}

}  // namespace

Array<double> areas(py::handle positions, py::handle triangles) {
    const std::vector<TwoEdges> all = edges(positions, triangles);
    Array<double> result(static_cast<py::ssize_t>(all.size()));
    double* area = result.mutable_data();
    for (const TwoEdges& two : all) *area++ = 0.5 * two.doubled_area();
    return result;
}

Array<double> rest_shapes(py::handle positions, py::handle triangles) {
    const std::vector<TwoEdges> all = edges(positions, triangles);
    Array<double> result({static_cast<py::ssize_t>(all.size()), py::ssize_t{4}});
    double* shape = result.mutable_data();
    for (const TwoEdges& two : all) {
        const auto& [a, b] = two;
        const double length = std::hypot(a[0], a[1], a[2]), doubled = two.doubled_area();
        const double along = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / length;
        const bool is_flat = doubled == 0.0;  // what is not finite stays so
        *shape++ = is_flat ? 0.0 : 1.0 / length;
        *shape++ = is_flat ? 0.0 : -along / doubled;
        *shape++ = 0.0;
        *shape++ = is_flat ? 0.0 : length / doubled;
    }
    return result;
}

Array<double> rest_hinges(py::handle positions, py::handle triangles) {
    edges(positions, triangles);  // refuses what does not fit
    const Array<double> points = vectors<double>(positions, "positions", std::nullopt);
    const auto at = points.unchecked<2>();
    const auto topology = Topology::build(triangle_list(triangles), static_cast<std::size_t>(at.shape(0)));
    const auto between = [&](std::uint32_t from, std::uint32_t to) {
        return std::array{at(to, 0) - at(from, 0), at(to, 1) - at(from, 1), at(to, 2) - at(from, 2)};
    };
    const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return std::array{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    Array<double> result({static_cast<py::ssize_t>(topology->hinge_count()), py::ssize_t{2}});
    double* rest = result.mutable_data();
    for (const auto& [e0, e1, o0, o1] : topology->hinges()) {
        const auto edge = between(e0, e1), first = cross(edge, between(e0, o0)), second = cross(between(e0, o1), edge);
        const double squared = dot(edge, edge);
        const double doubled = std::sqrt(dot(first, first)) + std::sqrt(dot(second, second));
        const bool is_flat = dot(first, first) == 0.0 || dot(second, second) == 0.0;
        *rest++ = is_flat ? 0.0 : std::atan2(dot(cross(first, second), edge) / std::sqrt(squared), dot(first, second));
        *rest++ = is_flat ? 0.0 : 2.0 * squared / doubled;
    }
    return result;
}

Array<double> area_change(py::handle positions, py::handle triangles, py::handle rest_areas) {
    Array<double> result = areas(positions, triangles);
    const auto count = static_cast<std::size_t>(result.shape(0));
    const Array<double> rest = numbers<double>(rest_areas, "rest_areas", count);
    double* change = result.mutable_data();
    for (std::size_t t = 0; t < count; ++t) {
        const double rest_area = rest.data()[t];
        change[t] = rest_area <= 0.0 ? 0.0 : std::abs(change[t] - rest_area) / rest_area;
    }
    return result;
}

}  // namespace apsl::python
