// SPDX-License-Identifier: MIT
#include "unit/reference/sample_cloths.hpp"

#include "unit/sample_meshes.hpp"

#include <apsl/reference.hpp>

#include <cmath>
#include <random>

namespace apsl::test {

std::vector<reference::TriangleGeometry<double>> SampleCloth::geometry() const {
    std::vector<reference::TriangleGeometry<double>> result;
    reference::triangle_geometries<double>(*topology, positions, result);
    return result;
}

std::vector<SampleCloth> wavy_cloths() {
    std::vector<SampleCloth> cloths;
    std::mt19937 random(7);
    for (const auto& [name, mesh] : small_meshes()) {
        SampleCloth cloth{
            name, Topology::build(mesh.triangles, mesh.vertex_count()), wavy(mesh.positions, 0.1), {}, {}};
        cloth.rest_areas = reference::areas<double>(*cloth.topology, mesh.positions);
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
            const double decades = 2.0 * static_cast<double>(random()) / 4294967296.0;
            cloth.inverse_masses.push_back(v % 7 == 6 ? 0.0 : std::pow(10.0, decades));
        }
        cloths.push_back(std::move(cloth));
    }
    return cloths;
}

SampleCloth grid_cloth(std::uint32_t columns, std::uint32_t rows, Diagonals diagonals) {
    const Mesh mesh = grid(columns, rows, 1.0, 1.0, diagonals);
    SampleCloth cloth{"grid", Topology::build(mesh.triangles, mesh.vertex_count()), mesh.positions, {}, {}};
    cloth.rest_areas = reference::areas<double>(*cloth.topology, cloth.positions);
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    return cloth;
}

}  // namespace apsl::test
