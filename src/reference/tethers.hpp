// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <apsl/reference.hpp>

#include <cstddef>
#include <cstdint>

// What vertices hang by, and how they are kept within reach (docs/formulation.md, Tethers).
namespace apsl::reference {

/// On to the next part of a step.
template <class Real>
struct Move {
    Real share;  ///< of the step
    Real time;   ///< s, from the start of the step to the end of the part
};

/// Δt times the velocity of `vertex` at x: as given, or one that leads no further than its tethers reach. An anchor
/// goes straight on with the velocity that it has at the start of the step, as a pinned vertex does.
template <class Real>
Vector3<Real> within_reach(const Vector3<Real>& x, const Vector3<Real>& motion, const Move<Real>& move,
                           const Buffers<Real>& buffers, std::size_t per_vertex, std::size_t vertex) {
    const Vector3<Real> free = x + move.share * motion;
    Vector3<Real> end = free;
    for (std::size_t t = per_vertex * vertex; t < per_vertex * (vertex + 1); ++t) {
        const std::size_t anchor = buffers.tether_anchors[t];
        const Real length = buffers.tether_lengths[t];
        if (!(length > Real(0)) || 3 * anchor >= buffers.positions.size()) continue;
        const Vector3<Real> at = position(buffers.positions, anchor) +
                                 move.time * position(std::span<const Real>(buffers.velocities), anchor);
        const Vector3<Real> from = end - at;
        if (from.norm() > length) end = at + length / from.norm() * from;
    }
    return end == free ? motion : Vector3<Real>((end - x) / move.share);
}

}  // namespace apsl::reference
