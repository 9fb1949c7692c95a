// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/springs.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace apsl::scenes {

/// Sum of ½ k (l − L)² over the springs: J. `positions` m, [3V].
double spring_energy(std::span<const Spring> springs, std::span<const double> positions);

/// The matrix M (1 + h d) − h² K of ImplicitSprings, never assembled: four numbers a spring.
///
/// A spring of length l, direction u from a to b, has force f_a = k (l − L) u and ∂f_a/∂x_b = k u uᵀ + t (I − u uᵀ)
/// with t = k (1 − L/l) (Baraff and Witkin 1998, Section 4.2, for a condition C = l − L). Under compression t < 0 and
/// the block is indefinite; there t is taken as 0, after Choi and Ko 2002, Section 4.2. The forces stay exact.
class SpringOperator {
public:
    SpringOperator(const ClothState& cloth, std::vector<Spring> springs);

    /// Takes springs, masses and pins as they are now.
    void linearize(const ClothState& cloth, double time_step, double damping);

    /// forces = spring forces at the cloth's positions, N, [3V], pinned vertices included.
    void spring_forces(const ClothState& cloth, std::span<double> forces) const;

    // All below: [3V], of the system last linearised.

    /// result = (M (1 + h d) − h² K) vector, zero at pinned vertices; `vector` must be zero there too.
    void apply(std::span<const double> vector, std::span<double> result) const;

    /// result += sign · h² K vector, at pinned vertices too.
    void add_stiffness(std::span<const double> vector, std::span<double> result, double sign = 1.0) const;

    /// Zero at pinned vertices.
    void clear_pinned(std::span<double> vector) const;

    /// result = inverse of the 3×3 blocks on the diagonal times vector, zero at pinned vertices.
    void precondition(std::span<const double> vector, std::span<double> result) const;

    std::span<const Spring> springs() const noexcept { return springs_; }
    std::size_t scratch_bytes() const noexcept;

private:
    /// h² ∂f_a/∂x_b of a spring: transverse · I + axial axialᵀ.
    struct Block {
        std::array<double, 3> axial;
        double transverse;
    };
    /// Upper triangle of a symmetric 3×3 matrix, rows one after the other.
    using Symmetric = std::array<double, 6>;

    void invert_diagonal();

    std::vector<Spring> springs_;
    std::vector<Block> blocks_;                // [springs]
    std::vector<double> inertia_;              // kg, [V], M (1 + h d), 0 at pinned vertices
    std::vector<Symmetric> inverse_diagonal_;  // 1/kg, [V], 0 at pinned vertices
};

}  // namespace apsl::scenes
