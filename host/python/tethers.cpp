// SPDX-License-Identifier: MIT
#include "tethers.hpp"

#include "values.hpp"

#include <apsl/tethers.hpp>

#include <algorithm>
#include <span>

namespace apsl::python {
namespace {

std::vector<std::uint32_t> pins(py::handle pinned) {
    const Array<std::uint32_t> given = indices(pinned, "pinned", "row", std::nullopt, 0);
    return {given.data(), given.data() + given.size()};
}

template <class Value>
Array<Value> rows_of(const std::vector<Value>& values, std::size_t columns) {
    const auto rows = static_cast<py::ssize_t>(values.size() / columns);
    Array<Value> result({rows, static_cast<py::ssize_t>(columns)});
    std::copy(values.begin(), values.end(), result.mutable_data());
    return result;
}

}  // namespace

py::tuple tethers_to_pins(py::handle rest_positions, py::handle triangles, py::handle pinned, py::handle per_vertex,
                          py::handle stretch) {
    const Array<float> positions = vectors<float>(rest_positions, "rest_positions", std::nullopt);
    const std::vector<Triangle> corners = triangle_list(triangles);
    const std::vector<std::uint32_t> pinned_vertices = pins(pinned);
    const auto count = from_python<std::uint32_t>(per_vertex, "per_vertex");
    const auto factor = from_python<float>(stretch, "stretch");
    const std::span<const float> numbers(positions.data(), static_cast<std::size_t>(positions.size()));
    Tethers tethers;
    {
        const py::gil_scoped_release others_may_run;
        const auto topology = Topology::build(corners, numbers.size() / 3);
        tethers = apsl::tethers_to_pins(*topology, numbers, pinned_vertices, count, factor);
    }
    return py::make_tuple(rows_of(tethers.anchors, count), rows_of(tethers.lengths, count));
}

std::size_t pinned_piece_count(py::handle triangles, py::handle vertex_count, py::handle pinned) {
    const std::vector<Triangle> corners = triangle_list(triangles);
    const auto count = from_python<std::uint32_t>(vertex_count, "vertex_count");
    const std::vector<std::uint32_t> pinned_vertices = pins(pinned);
    const py::gil_scoped_release others_may_run;
    return apsl::pinned_piece_count(*Topology::build(corners, count), pinned_vertices);
}

}  // namespace apsl::python
