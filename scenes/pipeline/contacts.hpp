// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/colliders.hpp"

#include <apsl/parameters.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace apsl::scenes {

/// Where a vertex goes in a step that nothing limits: x + seconds v + shift.
struct FreeFlight {
    double seconds = 0.0;
    std::array<double, 3> shift{};  ///< m
};

/// Under an acceleration (m/s²) and a damping (1/s) as Options::integrates has them, in infinitely many parts, and of
/// the damping of what is gained on the way the first order alone: it tells where to look for contact.
FreeFlight free_flight(const std::array<double, 3>& acceleration, double damping, double time_step);
FreeFlight free_flight(const Parameters& parameters);

/// Cosine of the angle between two normals up to which a way stays on one side of a collider.
inline constexpr double same_side = 0.5;
/// m. Nearer than this a way touches.
inline constexpr double touching = 1e-5;
/// Of sphere tracing. Each takes a way as far on as the collider is away.
inline constexpr int most_traced = 32;

/// Numbers that tell of a vertex's contact.
inline constexpr std::size_t contact_numbers = 8;

/// What a vertex is held off in a step, [8V]: unit normal n, offset d in m (n·x ≥ d at the end of the step), velocity
/// of the body there in m/s (t seconds before the end the plane stands at d − t n·velocity), coefficient of friction.
/// Zeros for a pinned vertex, and for all without colliders. The double-precision twin of fill_contacts.cl.
///
/// The plane is the tangent of a collider, its thickness included, at its point nearest to where free flight ends.
/// Where the vertex would have come round or through the collider by then, it is that at the point of its way which
/// touches first or comes nearest, so that nothing slips through and nothing beside a collider runs into its far side.
/// Of several colliders it is the one in which free flight ends deepest: in the wedge between two a vertex is held off
/// them by turns, and is some millimetres deep in the other.
/// Where the surface curves up in front of a vertex, its plane rises from the vertex: it does not begin above it.
/// Cloth that starts inside is led out as resolve_collisions does, by a plane above it that does not rise.
std::vector<double> contacts(const ClothState& cloth, std::span<const ColliderStep> colliders, const FreeFlight& flight,
                             double time_step);

}  // namespace apsl::scenes
