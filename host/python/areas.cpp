// SPDX-License-Identifier: MIT
#include "areas.hpp"

#include "values.hpp"

#include <array>
#include <cmath>
#include <string>

namespace apsl::python {

Array<double> areas(py::handle positions, py::handle triangles) {
    const Array<double> points = vectors<double>(positions, "positions", std::nullopt);
    const std::vector<Triangle> corners = triangle_list(triangles);
    const auto at = points.unchecked<2>();
    Array<double> result(static_cast<py::ssize_t>(corners.size()));
    double* area = result.mutable_data();
    for (std::size_t t = 0; t < corners.size(); ++t) {
        const auto& [i, j, k] = corners[t];
        for (const std::uint32_t vertex : corners[t])
            if (vertex >= points.shape(0))
                refuse("triangles", "vertex " + std::to_string(vertex) + " in triangle " + std::to_string(t),
                       "0 to " + std::to_string(points.shape(0) - 1) + ", as there are so many positions");
        std::array<double, 3> a{};
        std::array<double, 3> b{};
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            a[axis] = at(j, axis) - at(i, axis);
            b[axis] = at(k, axis) - at(i, axis);
        }
        area[t] = 0.5 * std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
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
