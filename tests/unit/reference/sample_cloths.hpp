// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"
#include "support/meshes.hpp"

#include <apsl/topology.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsl::test {

struct SampleCloth {
    std::string name;
    std::shared_ptr<const Topology> topology;
    std::vector<double> positions;       ///< m, [3V], out of rest
    std::vector<double> inverse_masses;  ///< 1/kg, [V]
    std::vector<double> rest_areas;      ///< m², [T]

    std::vector<reference::TriangleGeometry<double>> geometry() const;
};

/// Every small mesh, bent, its inverse masses spread over two decades, every seventh vertex pinned.
std::vector<SampleCloth> wavy_cloths();

/// A grid cloth of 1 m and 0.2 kg/m², lumped masses, no pins, at rest.
SampleCloth grid_cloth(std::uint32_t columns, std::uint32_t rows, Diagonals diagonals);

}  // namespace apsl::test
