// SPDX-License-Identifier: MIT
#include "pipeline/colliders.hpp"

#include "pipeline/geometry.hpp"

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
// m. What begins a step deeper inside than this began the simulation there.
constexpr double start_depth = 1e-4;
// s. In this time all but 1/e of the depth is gone.
constexpr double time_to_leave = 0.2;

struct Surface {
    double distance;  ///< m, negative inside
    Vector normal;    ///< unit, pointing out
};

// A unit vector across `axis` (unit, or zero for a sphere) for a place that lies on the axis itself: back to where the
// vertex came from, or else up, or else sideways.
Vector any_way_out(const Vector& axis, const Vector& back) {
    for (const Vector& candidate : {back, Vector(Vector::UnitY()), Vector(Vector::UnitX())}) {
        const Vector across = candidate - axis.dot(candidate) * axis;
        if (across.norm() > 1e-6 * candidate.norm()) return across.normalized();
    }
    return Vector::UnitX();
}

Surface surface(const Sphere& sphere, const Vector& place, const Vector& start) {
    const Vector center(sphere.center.data());
    const Vector offset = place - center;
    const double length = offset.norm();
    return {.distance = length - sphere.radius,
            .normal = length > 0.0 ? Vector(offset / length) : any_way_out(Vector::Zero(), start - center)};
}

Surface surface(const Plane& plane, const Vector& place, const Vector& /*start*/) {
    const Vector normal = Vector(plane.normal.data()).stableNormalized();
    return {.distance = normal.dot(place - Vector(plane.point.data())), .normal = normal};
}

Surface surface(const Capsule& capsule, const Vector& place, const Vector& start) {
    const Vector a(capsule.a.data());
    const Vector axis = Vector(capsule.b.data()) - a;
    const double squared_length = axis.squaredNorm();
    const double along = squared_length > 0.0 ? std::clamp(axis.dot(place - a) / squared_length, 0.0, 1.0) : 0.0;
    const Vector closest = a + along * axis;
    const Vector offset = place - closest;
    const double length = offset.norm();
    return {.distance = length - capsule.radius,
            .normal = length > 0.0 ? Vector(offset / length) : any_way_out(axis.stableNormalized(), start - closest)};
}

Surface surface(const Collider& collider, const Vector& place, const Vector& start) {
    return std::visit([&](const auto& shape) { return surface(shape, place, start); }, collider);
}

const Contact& contact_of(const Collider& collider) {
    return std::visit([](const auto& shape) -> const Contact& { return shape.contact; }, collider);
}

// Moves a vertex that begins the step inside a part of its way out. Returns how deep it may still be, m.
double lead_out_of(const Collider& collider, Eigen::Map<Vector> position, double time_step) {
    const auto [distance, normal] = surface(collider, position, position);
    const double depth = contact_of(collider).thickness - distance;
    if (!(depth > start_depth)) return 0.0;
    const double way = std::min(1.0, time_step / time_to_leave) * depth;
    position += way * normal;
    return depth - way;
}

// Pushes the predicted place of one vertex out of one collider, up to the depth it may have; whether it had to.
bool push_out(const Collider& collider, const Vector& position, Eigen::Map<Vector> velocity, double time_step,
              double allowed_depth, double ignored_depth) {
    const Vector place = position + time_step * velocity;
    const auto [distance, normal] = surface(collider, place, position);
    const Contact& contact = contact_of(collider);
    const double depth = contact.thickness - allowed_depth - distance;
    if (!(depth > ignored_depth)) return false;
    const double push = depth / time_step;
    velocity += push * normal;
    // Coulomb: the tangential impulse is at most μ times the normal one, and never turns the motion round.
    const double normal_speed = velocity.dot(normal);
    const Vector tangential = velocity - normal_speed * normal;
    const double speed = tangential.norm();
    if (contact.friction > 0.0 && speed > 0.0) velocity -= std::min(1.0, contact.friction * push / speed) * tangential;
    return true;
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

std::size_t resolve_collisions(ClothState& cloth, std::span<const Collider> colliders, double time_step,
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
