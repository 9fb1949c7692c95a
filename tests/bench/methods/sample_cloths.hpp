// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"
#include "support/meshes.hpp"

#include <initializer_list>
#include <string>
#include <vector>

namespace apsl::test {

/// At rest where the mesh lies; every vertex of mass 1 kg, those named pinned. Time step 0.1 s.
methods::Cloth cloth_of(const Mesh& mesh, std::initializer_list<std::uint32_t> pinned = {});

/// Columns × columns vertices on 1 m × 1 m, alternating diagonals, the two corners of the first row pinned.
methods::Cloth hanging_grid(std::uint32_t columns);

std::vector<Eigen::Vector3f> rest_of(const methods::Cloth& cloth);

/// The rest positions stretched by `factor` along z and bent out of their plane. Pinned vertices (first row) move too.
std::vector<Eigen::Vector3f> stretched(const methods::Cloth& cloth, float factor);

/// What a method makes of these positions.
std::vector<Eigen::Vector3f> projected(const methods::Cloth& cloth, const std::string& method,
                                       std::vector<Eigen::Vector3f> positions,
                                       std::vector<methods::Parameter> parameters = {});

float area(const Triangle& triangle, const std::vector<Eigen::Vector3f>& positions);
/// Greatest |A − A⁰| / A⁰.
float greatest_area_change(const methods::Cloth& cloth, const std::vector<Eigen::Vector3f>& positions);
/// Greatest and least |x_b − x_a| / L over the edges.
float greatest_edge_ratio(const methods::Cloth& cloth, const std::vector<Eigen::Vector3f>& positions);
float least_edge_ratio(const methods::Cloth& cloth, const std::vector<Eigen::Vector3f>& positions);

/// Σ m x over vertices that are not pinned.
Eigen::Vector3d first_moment(const methods::Cloth& cloth, const std::vector<Eigen::Vector3f>& positions);
bool same_bytes(const std::vector<Eigen::Vector3f>& left, const std::vector<Eigen::Vector3f>& right);

}  // namespace apsl::test
