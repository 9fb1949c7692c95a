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

/// What holds `vertex`. One that starts the step out of reach is led back over it. Anchors go straight on with the
/// velocities that they have at the start of the step, as pinned vertices do. Where they are further apart than two
/// tethers together reach, nothing could be within reach of both: then all tethers of the vertex are longer in the same
/// ratio.
template <class Real>
std::vector<Hold<Real>> holds(const Move<Real>& move, const Buffers<Real>& buffers, std::size_t per_vertex,
                              std::size_t vertex) {
    std::vector<Hold<Real>> found;
    for (std::size_t t = per_vertex * vertex; t < per_vertex * (vertex + 1); ++t) {
        const std::size_t anchor = buffers.tether_anchors[t];
        if (!(buffers.tether_lengths[t] > Real(0)) || 3 * anchor >= buffers.positions.size()) continue;
        const Vector3<Real> velocity = position(std::span<const Real>(buffers.velocities), anchor);
        const Vector3<Real> start = position(buffers.positions, anchor);
        const Real length = buffers.tether_lengths[t],
                   excess = std::max((position(buffers.positions, vertex) - start).norm() - length, Real(0));
        found.push_back({start + move.time * velocity, move.time_step * velocity,
                         length + (Real(1) - move.time / move.time_step) * excess});
    }
    Real stretch = Real(1);
    for (const Hold<Real>& a : found)
        for (const Hold<Real>& b : found) stretch = std::max(stretch, (a.at - b.at).norm() / (a.reach + b.reach));
    for (Hold<Real>& hold : found) hold.reach *= stretch;
    return found;
}

/// A vertex at x and Δt times its velocity, such that the part ends within reach of its anchors and no faster away from
/// them than they go.
template <class Real>
void keep_within_reach(Eigen::Ref<Vector3<Real>> x, Eigen::Ref<Vector3<Real>> motion, const Move<Real>& move,
                       const std::vector<Hold<Real>>& holds) {
    Vector3<Real> end = x + move.share * motion;
    bool held = false;
    for (const Hold<Real>& hold : holds) {
        const Vector3<Real> from = end - hold.at;
        if (!(from.norm() > hold.reach)) continue;
        const Vector3<Real> away = from.normalized();
        end = hold.at + hold.reach * away;
        motion -= std::max((motion - hold.motion).dot(away), Real(0)) * away;
        held = true;
    }
    if (held) x = end - move.share * motion;
}

}  // namespace apsl::reference
