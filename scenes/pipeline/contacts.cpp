// SPDX-License-Identifier: MIT
#include "pipeline/contacts.hpp"

#include "pipeline/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl::scenes {
namespace {

using Vector = Eigen::Vector3d;

// Off the thickness of the contact.
Surface contact_surface(const Collider& collider, const Vector& place, const Vector& start) {
    Surface met = surface(collider, place, start);
    met.distance -= contact_of(collider).thickness;
    return met;
}

// Where to lay the plane. `start`: where the step begins, carried along with the collider.
Vector place_of_contact(const Collider& collider, const Vector& start, const Vector& end) {
    const Surface at_start = contact_surface(collider, start, start), at_end = contact_surface(collider, end, start);
    if (at_start.normal.dot(at_end.normal) >= same_side) return end;
    const Vector way = end - start;
    Vector nearest = start;
    double least = at_start.distance, distance = at_start.distance, share = 0.0;
    for (int n = 0; n < most_traced && least > touching; ++n) {
        share += distance / way.norm();
        const Vector place = share < 1.0 ? Vector(start + share * way) : end;
        distance = contact_surface(collider, place, start).distance;
        if (distance < least) {
            least = distance;
            nearest = place;
        }
        if (!(share < 1.0)) break;
    }
    return nearest;
}

struct VertexContact {
    double gap = std::numeric_limits<double>::infinity();  ///< m, that free flight leaves
    Vector normal = Vector::Zero();
    double offset = 0.0;
    Vector velocity = Vector::Zero();
    double friction = 0.0;
};

VertexContact contact_with(const ColliderStep& collider, const Vector& position, const Vector& end, double time_step) {
    const Vector start = position + time_step * velocity_at(collider, position);
    const Vector place = place_of_contact(collider.shape, start, end);
    const auto [distance, normal] = contact_surface(collider.shape, place, start);
    const double depth = -contact_surface(collider.shape, start, start).distance;
    const double allowed = depth > start_depth ? depth * (1.0 - std::min(1.0, time_step / time_to_leave)) : 0.0;
    const double offset = normal.dot(place) - distance - allowed;
    Vector velocity = velocity_at(collider, place - distance * normal);
    const double led_out = std::max(depth, 0.0) - allowed;
    const double rise = (offset - led_out - normal.dot(position)) / time_step - normal.dot(velocity);
    velocity += std::max(rise, 0.0) * normal;
    return {.gap = normal.dot(end) - offset,
            .normal = normal,
            .offset = offset,
            .velocity = velocity,
            .friction = contact_of(collider.shape).friction};
}

}  // namespace

FreeFlight free_flight(const std::array<double, 3>& acceleration, double damping, double time_step) {
    const double seconds = damping > 0.0 ? -std::expm1(-damping * time_step) / damping : time_step;
    FreeFlight flight{.seconds = seconds};
    for (std::size_t k = 0; k < 3; ++k) flight.shift[k] = 0.5 * time_step * seconds * acceleration[k];
    return flight;
}

FreeFlight free_flight(const Parameters& parameters) {
    const auto& [x, y, z] = parameters.acceleration;
    return free_flight({x, y, z}, static_cast<double>(parameters.damping), static_cast<double>(parameters.time_step));
}

std::vector<double> contacts(const ClothState& cloth, std::span<const ColliderStep> colliders, const FreeFlight& flight,
                             double time_step) {
    std::vector<double> records(contact_numbers * cloth.inverse_masses.size(), 0.0);
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        if (cloth.inverse_masses[v] == 0.0) continue;
        const Vector position = vector_at(std::span(cloth.positions), v);
        const Vector end =
            position + flight.seconds * vector_at(std::span(cloth.velocities), v) + Vector(flight.shift.data());
        VertexContact deepest;
        for (const ColliderStep& collider : colliders) {
            const VertexContact contact = contact_with(collider, position, end, time_step);
            if (contact.gap < deepest.gap) deepest = contact;
        }
        double* record = records.data() + contact_numbers * v;
        for (Eigen::Index k = 0; k < 3; ++k) {
            record[k] = deepest.normal[k];
            record[4 + k] = deepest.velocity[k];
        }
        record[3] = deepest.offset;
        record[7] = deepest.friction;
    }
    return records;
}

}  // namespace apsl::scenes
