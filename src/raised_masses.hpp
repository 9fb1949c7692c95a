// SPDX-License-Identifier: MIT
#pragma once

namespace apsl {

/// The least effective mass of a vertex, in stiffnesses of the tension around it. Explicit steps swing from ½ down,
/// with growing amplitude (docs/formulation.md, Effective masses).
inline constexpr float mass_per_stiffness = 2.0f;
/// What is left of a stiffness one sub-step later: a swing passes through zero tension.
inline constexpr float stiffness_kept = 0.9f;
/// The greatest effective mass, in geometric mean masses of the cloth. A heavier vertex needs more pressure, which
/// stiffens it.
inline constexpr float greatest_mean_masses = 10.0f;

}  // namespace apsl
