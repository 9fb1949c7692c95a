// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <vector>

namespace apsl::scenes {

/// Length over rest length. Edges of rest length 0 are not counted; 1 and 1 where there are no others.
struct EdgeStretch {
    double min = 1.0;
    double max = 1.0;
};

/// Over all edges, at the current positions.
EdgeStretch edge_stretch(const ClothState& cloth);

/// Least and greatest singular value of a triangle's 3×2 deformation gradient F = [x₁−x₀ x₂−x₀] Dₘ⁻¹, with Dₘ the same
/// edges at rest in the triangle's own plane. 1 is neither stretched nor compressed.
struct PrincipalStretch {
    double min = 1.0;
    double max = 1.0;
};

/// Of every triangle, [T]; 1 and 1 where it has no rest area.
std::vector<PrincipalStretch> principal_stretches(const ClothState& cloth);

/// The least and the greatest of all.
PrincipalStretch range_of(const std::vector<PrincipalStretch>& stretches);

/// Of |A − A⁰| / A⁰ over the triangles with A⁰ > 0.
struct AreaChange {
    double max = 0.0;
    double rms = 0.0;
};

/// |A − A⁰| / A⁰ at x + Δt v, [T]: what the filter reports, for scenes without one and for colouring. 0 where A⁰ is 0.
std::vector<double> predicted_area_changes(const ClothState& cloth, double time_step);

/// The same at the current positions.
std::vector<double> area_changes(const ClothState& cloth);

/// Greatest |A − A⁰| / A⁰ at the current positions of the triangles whose three corners are pinned. No limiter can do
/// anything about it.
double pinned_area_change(const ClothState& cloth);

/// Greatest and RMS of `changes` over the triangles with A⁰ > 0.
AreaChange summarize(const ClothState& cloth, const std::vector<double>& changes);

}  // namespace apsl::scenes
