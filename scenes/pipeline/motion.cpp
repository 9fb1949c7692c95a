// SPDX-License-Identifier: MIT
#include "pipeline/motion.hpp"

#include "pipeline/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace apsl::scenes {
namespace {

bool finite(const std::array<double, 3>& vector) {
    return std::all_of(vector.begin(), vector.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

std::string fault_of(const Motion& motion) {
    if (!std::isfinite(motion.start) || !(motion.stop >= motion.start))
        return "expected a finite start and stop ≥ start (s)";
    if (const auto* translation = std::get_if<Translation>(&motion.path); translation != nullptr)
        return finite(translation->velocity) ? "" : "the velocity is not finite";
    if (const auto* rotation = std::get_if<Rotation>(&motion.path); rotation != nullptr) {
        if (!std::isfinite(rotation->degrees_per_second)) return "degrees_per_second is not finite";
        if (rotation->center.has_value() && !finite(*rotation->center)) return "the center is not finite";
        const double length = Eigen::Vector3d(rotation->axis.data()).stableNorm();
        if (!std::isfinite(length) || length == 0.0) return "the axis of a rotation must be finite and not zero";
    }
    return {};
}

bool moves(const Motion& motion) {
    if (motion.stop == motion.start) return false;
    if (const auto* translation = std::get_if<Translation>(&motion.path); translation != nullptr)
        return translation->velocity != std::array<double, 3>{};
    if (const auto* rotation = std::get_if<Rotation>(&motion.path); rotation != nullptr)
        return rotation->degrees_per_second != 0.0;
    return false;
}

double seconds_in_motion(const Motion& motion, double time) {
    return std::clamp(time, motion.start, motion.stop) - motion.start;
}

std::array<double, 3> carried(const Motion& motion, const std::array<double, 3>& place, double seconds) {
    if (seconds == 0.0) return place;
    Eigen::Vector3d end(place.data());
    if (const auto* translation = std::get_if<Translation>(&motion.path); translation != nullptr)
        end += seconds * Eigen::Vector3d(translation->velocity.data());
    if (const auto* rotation = std::get_if<Rotation>(&motion.path); rotation != nullptr) {
        const double angle = rotation->degrees_per_second * seconds * std::numbers::pi / 180.0;
        const Eigen::Vector3d axis = Eigen::Vector3d(rotation->axis.data()).stableNormalized();
        const Eigen::Vector3d center(rotation->center->data());
        end = center + Eigen::AngleAxisd(angle, axis) * (end - center);
    }
    return {end.x(), end.y(), end.z()};
}

}  // namespace apsl::scenes
