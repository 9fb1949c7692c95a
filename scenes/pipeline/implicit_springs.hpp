// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/springs.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace apsl::scenes {

/// How the last solve of ImplicitSprings ended.
struct SpringSolve {
    int iterations = 0;
    double residual = 0.0;  ///< ‖r‖ / ‖b‖, norm of the inverse block diagonal
    bool converged = true;
};

/// Backward Euler on springs, gravity and damping, after Baraff and Witkin 1998, Eq. (6) and Section 5:
///     (M (1 + h d) − h² K) Δv = h (f + h K v − d M v),   K = ∂f/∂x,  f = spring forces + M g,  d = damping,
/// one linear solve a step by conjugate gradients with 3×3 block-Jacobi preconditioning, over the free vertices alone:
/// pinned ones keep the velocity they were given, as their filtered CG has it.
class ImplicitSprings {
public:
    /// `damping`: 1/s on velocity, ≥ 0. No springs at all is free fall.
    /// Throws Error(invalid_argument): a spring that names a vertex out of range or one vertex twice, a rest length or
    /// stiffness that is negative or not finite, damping that is negative or not finite.
    ImplicitSprings(const ClothState& cloth, std::vector<Spring> springs, double damping);
    ~ImplicitSprings();
    ImplicitSprings(ImplicitSprings&&) noexcept;
    ImplicitSprings& operator=(ImplicitSprings&&) noexcept;

    /// Velocities of the free vertices at the end of the step; positions stay. `gravity` m/s², `time_step` s, > 0.
    /// Positions or velocities that are not finite leave the velocities as they were: converged is false.
    SpringSolve advance_velocities(ClothState& cloth, const std::array<double, 3>& gravity, double time_step);

    std::span<const Spring> springs() const noexcept;
    /// Bytes held between steps.
    std::size_t scratch_bytes() const noexcept;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace apsl::scenes
