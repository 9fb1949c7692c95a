// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "pipeline/motion.hpp"

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

/// A rotation without a center turns about the sphere's center, the middle of the capsule's axis, the plane's point.
struct MovingCollider {
    Collider shape;  ///< where it is at first
    Motion motion{};
};

/// A collider in a time step.
struct ColliderStep {
    Collider shape;  ///< where it is at the end
    /// What the step moves the body by, over its length: what is at p (m) at the end has come there with the velocity
    /// turning p + drift, which is a chord where it turns. `turning` 1/s, row by row, `drift` m/s.
    std::array<double, 9> turning{};
    std::array<double, 3> drift{};
};

/// The step from `time` (s) on.
ColliderStep collider_step(const MovingCollider& collider, double time, double time_step);

/// Throws Error(invalid_argument) naming the field that is out of range or not finite.
void validate(const Collider& collider);

/// Free vertices inside of a collider, its thickness included, by more than a step leaves behind.
struct StartInside {
    std::size_t vertices = 0;
    double depth = 0.0;  ///< m, the greatest
};

StartInside start_inside(const ClothState& cloth, const Collider& collider);

/// Collision response on velocities, vertex by vertex, after the filter: where x + Δt v lies inside a collider, v is
/// changed so that it lies on the surface, and friction takes up to μ times that change off the tangential velocity
/// relative to the collider. Only the end of the step is looked at: what crosses a collider whole within one step is
/// not seen. Pinned vertices are left alone. Colliders are not checked here (see validate). `lead_out`: for cloth that
/// starts inside, which would leave at depth / Δt and keep that speed. Then its position is moved towards the surface
/// by a part of its depth, and its velocity changed only so that it comes no deeper again. Returns the number of
/// vertices whose velocity was changed. Throws Error(invalid_argument) unless time_step > 0.
std::size_t resolve_collisions(ClothState& cloth, std::span<const ColliderStep> colliders, double time_step,
                               bool lead_out = false);

}  // namespace apsl::scenes
