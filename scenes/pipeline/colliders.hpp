// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <variant>

namespace apsl::scenes {

/// What a cloth meets at a collider's surface.
struct Contact {
    double friction = 0.0;   ///< Coulomb's coefficient, ≥ 0
    double thickness = 0.0;  ///< m, ≥ 0, how far off the surface the cloth is kept
};

struct Sphere {
    std::array<double, 3> center{};
    double radius = 0.0;  ///< m, > 0
    Contact contact{};
};

/// Everything on the side that `normal` points away from is inside.
struct Plane {
    std::array<double, 3> point{};
    std::array<double, 3> normal{0.0, 1.0, 0.0};  ///< any length but zero
    Contact contact{};
};

/// All points within `radius` of the segment from a to b.
struct Capsule {
    std::array<double, 3> a{};
    std::array<double, 3> b{};
    double radius = 0.0;  ///< m, > 0
    Contact contact{};
};

using Collider = std::variant<Sphere, Plane, Capsule>;

/// Throws Error(invalid_argument) naming the field that is out of range or not finite.
void validate(const Collider& collider);

/// Collision response on velocities, vertex by vertex, after the filter: where x + Δt v lies inside a collider, v is
/// changed so that it lies on the surface (what starts inside leaves within one step, and keeps that speed), and
/// friction takes up to μ times that change off the tangential velocity. Only the end of the step is looked at: what
/// crosses a collider whole within one step is not seen. Pinned vertices are left alone. Colliders stand still and are
/// not checked here (see validate). Returns the number of vertices touched. Throws Error(invalid_argument) unless
/// time_step > 0.
std::size_t resolve_collisions(ClothState& cloth, std::span<const Collider> colliders, double time_step);

}  // namespace apsl::scenes
