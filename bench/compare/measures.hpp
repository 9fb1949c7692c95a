// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <array>
#include <span>
#include <vector>

namespace apsl::compare {

/// Least and greatest singular value over all triangles of the 3×2 deformation gradient F = [x₁−x₀ x₂−x₀] Dₘ⁻¹, with Dₘ
/// the same edges at rest in the triangle's own plane. 1 is neither stretched nor compressed. Triangles without a rest
/// area are not counted.
struct PrincipalStretch {
    double min = 1.0;
    double max = 1.0;
};
PrincipalStretch principal_stretch(const scenes::ClothState& cloth);

/// Distance of each vertex from where it should be: m.
struct Deviation {
    double rms = 0.0;
    double max = 0.0;
};
/// Of positions from others of the same size: m, [3V], V ≥ 1.
Deviation deviation(std::span<const double> positions, std::span<const double> expected);

/// m, mean over the free vertices of the way from their rest positions; zero where there are none.
std::array<double, 3> mean_displacement(const scenes::ClothState& cloth);

}  // namespace apsl::compare
