// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "support/meshes.hpp"

#include <cstdint>
#include <vector>

namespace apsl::scenes {

/// The mesh as a cloth of 0.2 kg/m² at rest.
ClothState sample_cloth(const test::Mesh& mesh, const std::vector<std::uint32_t>& pinned = {});

/// Numbers in [−amplitude, amplitude), the same for the same seed.
std::vector<double> noise(std::size_t count, double amplitude, std::uint32_t seed);

double norm(const std::vector<double>& values);

/// values + factor · change.
std::vector<double> moved(const std::vector<double>& values, double factor, const std::vector<double>& change);

/// Σ m v, kg m/s.
std::vector<double> momentum(const ClothState& cloth);

/// Σ ½ m |v|², J.
double kinetic_energy(const ClothState& cloth);

}  // namespace apsl::scenes
