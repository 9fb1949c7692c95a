// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include <apsl/reference.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

// What vertices hang by, and how they are kept within reach (docs/formulation.md, Tethers).
namespace apsl::reference {

/// On to the next part of a step.
template <class Real>
struct Move {
    Real share;      ///< of the step
    Real time;       ///< s, from the start of the step to the end of the part
    Real time_step;  ///< s
};

/// Where an anchor is at the end of a part, and how far a vertex may then be from it.
template <class Real>
struct Hold {
    Vector3<Real> at;
    Vector3<Real> motion;  ///< m, Δt times its velocity
    Real reach;
};

/// What holds `vertex`: anchors that are pinned. They go straight on with the velocities that they have at the start of
/// the step. Where they are further apart than two tethers together reach, nothing could be within reach of both: then
/// all tethers of the vertex are longer in the same ratio.
template <class Real>
std::vector<Hold<Real>> holds(const Move<Real>& move, const Buffers<Real>& buffers, std::size_t per_vertex,
                              std::size_t vertex) {
    std::vector<Hold<Real>> found;
    for (std::size_t t = per_vertex * vertex; t < per_vertex * (vertex + 1); ++t) {
        const std::size_t anchor = buffers.tether_anchors[t];
        if (!(buffers.tether_lengths[t] > Real(0)) || 3 * anchor >= buffers.positions.size()) continue;
        if (buffers.inverse_masses[anchor] != Real(0)) continue;
        const Vector3<Real> velocity = position(std::span<const Real>(buffers.velocities), anchor);
        found.push_back({position(buffers.positions, anchor) + move.time * velocity, move.time_step * velocity,
                         buffers.tether_lengths[t]});
    }
    Real stretch = Real(1);
    for (const Hold<Real>& a : found)
        for (const Hold<Real>& b : found) stretch = std::max(stretch, (a.at - b.at).norm() / (a.reach + b.reach));
    for (Hold<Real>& hold : found) hold.reach *= stretch;
    return found;
}

/// Δt times the velocity of a vertex at x, without what would lead it out of reach in this part: a tether takes speed
/// away from its anchor, moves nothing and pulls nothing back.
template <class Real>
Vector3<Real> within_reach(const Vector3<Real>& x, Vector3<Real> motion, const Move<Real>& move,
                           const std::vector<Hold<Real>>& holds) {
    for (const Hold<Real>& hold : holds) {
        const Vector3<Real> from = x + move.share * motion - hold.at;
        const Real excess = from.norm() - hold.reach;
        if (!(excess > Real(0))) continue;
        const Vector3<Real> away = from.normalized();
        const Real outwards = std::max((motion - hold.motion).dot(away), Real(0));
        motion -= std::min(excess / move.share, outwards) * away;
    }
    return motion;
}

}  // namespace apsl::reference
