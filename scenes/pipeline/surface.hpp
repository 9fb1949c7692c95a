// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/colliders.hpp"
#include "pipeline/geometry.hpp"

namespace apsl::scenes {

/// Of a collider, as seen from a place.
struct Surface {
    double distance;         ///< m, negative inside
    Eigen::Vector3d normal;  ///< unit, pointing out
};

/// At `place` (m), without the thickness of the contact. Where that is the very center or axis the normal points to
/// where the vertex came from, `start`.
Surface surface(const Collider& collider, const Eigen::Vector3d& place, const Eigen::Vector3d& start);

const Contact& contact_of(const Collider& collider);

/// m/s, of what is at `place` at the end of the step.
Eigen::Vector3d velocity_at(const ColliderStep& collider, const Eigen::Vector3d& place);

/// m. What begins a step deeper inside than this began the simulation there.
inline constexpr double start_depth = 1e-4;
/// s. In this time all but 1/e of the depth is gone.
inline constexpr double time_to_leave = 0.2;

}  // namespace apsl::scenes
