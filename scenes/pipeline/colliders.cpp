// SPDX-License-Identifier: MIT
#include "pipeline/colliders.hpp"

#include "pipeline/surface.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace apsl::scenes {

namespace {

using Vector = Eigen::Vector3d;

// A vertex in the wedge between two colliders is pushed to and fro, each time by less, the slower the sharper the
// wedge. After this many rounds the last push stands.
constexpr int max_rounds = 128;
// m. From the second round on, less than this counts as on the surface: a push leaves rounding errors behind.
constexpr double slack = 1e-10;

// Moves a vertex that begins the step inside a part of its way out. Returns how deep it may still be, m.
double lead_out_of(const ColliderStep& collider, Eigen::Map<Vector> position, double time_step) {
    // Carried along with the collider.
    const Vector place = position + time_step * velocity_at(collider, position);
    const auto [distance, normal] = surface(collider.shape, place, place);
    const double depth = contact_of(collider.shape).thickness - distance;
    if (!(depth > start_depth)) return 0.0;
    const double way = std::min(1.0, time_step / time_to_leave) * depth;
    position += way * normal;
    return depth - way;
}

// Pushes the predicted place of one vertex out of one collider, up to the depth it may have; whether it had to.
bool push_out(const ColliderStep& collider, const Vector& position, Eigen::Map<Vector> velocity, double time_step,
              double allowed_depth, double ignored_depth) {
    const Vector place = position + time_step * velocity;
    const auto [distance, normal] = surface(collider.shape, place, position);
    const Contact& contact = contact_of(collider.shape);
    const double depth = contact.thickness - allowed_depth - distance;
    if (!(depth > ignored_depth)) return false;
    const double push = depth / time_step;
    velocity += push * normal;
    // Coulomb: the tangential impulse is at most μ times the normal one, and never turns the motion round.
    const Vector sliding = velocity - velocity_at(collider, place + depth * normal);
    const Vector tangential = sliding - sliding.dot(normal) * normal;
    const double speed = tangential.norm();
    if (contact.friction > 0.0 && speed > 0.0) velocity -= std::min(1.0, contact.friction * push / speed) * tangential;
    return true;
}

std::array<double, 3> middle_of(const Collider& collider) {
    if (const auto* sphere = std::get_if<Sphere>(&collider)) return sphere->center;
    if (const auto* plane = std::get_if<Plane>(&collider)) return plane->point;
    const auto& [a, b, radius, contact] = std::get<Capsule>(collider);
    return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
}

Collider carry(Sphere sphere, const Motion& motion, double seconds) {
    sphere.center = carried(motion, sphere.center, seconds);
    return sphere;
}

Collider carry(Plane plane, const Motion& motion, double seconds) {
    if (std::holds_alternative<Rotation>(motion.path)) {
        // About an axis through the origin.
        Motion turning = motion;
        std::get<Rotation>(turning.path).center = std::array<double, 3>{};
        plane.normal = carried(turning, plane.normal, seconds);
    }
    plane.point = carried(motion, plane.point, seconds);
    return plane;
}

Collider carry(Capsule capsule, const Motion& motion, double seconds) {
    capsule.a = carried(motion, capsule.a, seconds);
    capsule.b = carried(motion, capsule.b, seconds);
    return capsule;
}

[[noreturn]] void fail(const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "collider: " + what);
}

void check_point(const std::array<double, 3>& point, const std::string& name) {
    if (!std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); }))
        fail(name + " is not finite");
}

void check_radius(double radius) {
    if (!(radius > 0.0) || !std::isfinite(radius))
        fail("radius must be positive and finite (m), got " + std::to_string(radius));
}

void check_shape(const Sphere& sphere) {
    check_point(sphere.center, "center");
    check_radius(sphere.radius);
}

void check_shape(const Plane& plane) {
    check_point(plane.point, "point");
    check_point(plane.normal, "normal");
    if (Vector(plane.normal.data()).stableNorm() == 0.0) fail("normal must not be zero");
}

void check_shape(const Capsule& capsule) {
    check_point(capsule.a, "a");
    check_point(capsule.b, "b");
    check_radius(capsule.radius);
}

void check_contact(const Contact& contact) {
    if (!(contact.friction >= 0.0) || !std::isfinite(contact.friction))
        fail("friction must be finite and ≥ 0, got " + std::to_string(contact.friction));
    if (!(contact.thickness >= 0.0) || !std::isfinite(contact.thickness))
        fail("thickness must be finite and ≥ 0 (m), got " + std::to_string(contact.thickness));
}

}  // namespace

ColliderStep collider_step(const MovingCollider& collider, double time, double time_step) {
    Motion motion = collider.motion;
    if (auto* rotation = std::get_if<Rotation>(&motion.path))
        rotation->center = rotation->center.value_or(middle_of(collider.shape));
    const double before = seconds_in_motion(motion, time), after = seconds_in_motion(motion, time + time_step);
    ColliderStep step{.shape =
                          std::visit([&](const auto& shape) { return carry(shape, motion, after); }, collider.shape)};
    if (after == before) return step;
    // What turns and shifts is affine: known from what it does to the origin and to the three axes.
    const auto velocity = [&](const std::array<double, 3>& place) {
        return Vector((Vector(place.data()) - Vector(carried(motion, place, before - after).data())) / time_step);
    };
    const Vector drift = velocity({});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<double, 3> unit{};
        unit[axis] = 1.0;
        const Vector column = velocity(unit) - drift;
        for (std::size_t row = 0; row < 3; ++row) step.turning[3 * row + axis] = column[static_cast<Eigen::Index>(row)];
        step.drift[axis] = drift[static_cast<Eigen::Index>(axis)];
    }
    return step;
}

void validate(const Collider& collider) {
    std::visit(
        [](const auto& shape) {
            check_shape(shape);
            check_contact(shape.contact);
        },
        collider);
}

StartInside start_inside(const ClothState& cloth, const Collider& collider) {
    StartInside inside;
    const std::span<const double> positions = cloth.positions;
    for (std::size_t vertex = 0; vertex < cloth.inverse_masses.size(); ++vertex) {
        if (cloth.inverse_masses[vertex] == 0.0) continue;
        const Vector place = vector_at(positions, vertex);
        const double depth = contact_of(collider).thickness - surface(collider, place, place).distance;
        if (depth > start_depth) {
            ++inside.vertices;
            inside.depth = std::max(inside.depth, depth);
        }
    }
    return inside;
}

std::size_t resolve_collisions(ClothState& cloth, std::span<const ColliderStep> colliders, double time_step,
                               bool lead_out) {
    if (!(time_step > 0.0)) {
        throw Error(ErrorCode::invalid_argument,
                    "collisions: time_step must be positive (s), got " + std::to_string(time_step));
    }
    std::vector<double> allowed_depths(colliders.size(), 0.0);
    std::size_t touched_vertices = 0;
    for (std::size_t vertex = 0; vertex < cloth.inverse_masses.size(); ++vertex) {
        if (cloth.inverse_masses[vertex] == 0.0) continue;
        const Eigen::Map<Vector> position = vector_at(std::span(cloth.positions), vertex);
        for (std::size_t k = 0; lead_out && k < colliders.size(); ++k)
            allowed_depths[k] = lead_out_of(colliders[k], position, time_step);
        for (int round = 0; round < max_rounds; ++round) {
            bool touched = false;
            for (std::size_t k = 0; k < colliders.size(); ++k) {
                touched |= push_out(colliders[k], position, vector_at(std::span(cloth.velocities), vertex), time_step,
                                    allowed_depths[k], round == 0 ? 0.0 : slack);
            }
            if (!touched) break;
            touched_vertices += round == 0 ? 1 : 0;
        }
    }
    return touched_vertices;
}

}  // namespace apsl::scenes
