// SPDX-License-Identifier: MIT
#include "pipeline/surface.hpp"

#include <algorithm>

namespace apsl::scenes {
namespace {

using Vector = Eigen::Vector3d;

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

}  // namespace

Surface surface(const Collider& collider, const Vector& place, const Vector& start) {
    return std::visit([&](const auto& shape) { return surface(shape, place, start); }, collider);
}

const Contact& contact_of(const Collider& collider) {
    return std::visit([](const auto& shape) -> const Contact& { return shape.contact; }, collider);
}

Vector velocity_at(const ColliderStep& collider, const Vector& place) {
    using Turning = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    return Turning(collider.turning.data()) * place + Vector(collider.drift.data());
}

}  // namespace apsl::scenes
