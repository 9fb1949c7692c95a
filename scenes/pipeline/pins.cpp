// SPDX-License-Identifier: MIT
#include "pipeline/pins.hpp"

#include "pipeline/geometry.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace apsl::scenes {

namespace {

[[noreturn]] void fail(std::size_t group, const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "pin group " + std::to_string(group) + ": " + what);
}

bool finite(const std::array<double, 3>& vector) {
    return std::all_of(vector.begin(), vector.end(), [](double x) { return std::isfinite(x); });
}

void check_vertices(const ClothState& cloth, const PinGroup& group, std::size_t index) {
    for (const std::uint32_t vertex : group.vertices) {
        if (vertex >= cloth.inverse_masses.size()) {
            fail(index, "vertex " + std::to_string(vertex) + " is out of range, the mesh has " +
                            std::to_string(cloth.inverse_masses.size()) + " vertices");
        }
        if (cloth.inverse_masses[vertex] != 0.0)
            fail(index, "vertex " + std::to_string(vertex) + " is not pinned in the cloth (expected inverse mass 0)");
    }
}

std::array<double, 3> centroid(const ClothState& cloth, const std::vector<std::uint32_t>& vertices) {
    const std::span<const double> rest_positions = cloth.rest_positions;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::uint32_t vertex : vertices) sum += vector_at(rest_positions, vertex);
    if (!vertices.empty()) sum /= static_cast<double>(vertices.size());
    return {sum.x(), sum.y(), sum.z()};
}

void check_motion(const PinMotion& motion, std::size_t index) {
    if (!std::isfinite(motion.start) || !(motion.stop >= motion.start))
        fail(index, "expected a finite start and stop ≥ start (s)");
    if (const auto* translation = std::get_if<PinTranslation>(&motion.path); translation != nullptr) {
        if (!finite(translation->velocity)) fail(index, "the velocity is not finite");
    }
    if (const auto* rotation = std::get_if<PinRotation>(&motion.path); rotation != nullptr) {
        if (!std::isfinite(rotation->degrees_per_second)) fail(index, "degrees_per_second is not finite");
        if (rotation->center.has_value() && !finite(*rotation->center)) fail(index, "the center is not finite");
        const double length = Eigen::Vector3d(rotation->axis.data()).stableNorm();
        if (!std::isfinite(length) || length == 0.0) fail(index, "the axis of a rotation must be finite and not zero");
    }
}

// Seconds in motion at `time`.
double phase(const PinMotion& motion, double time) {
    return std::clamp(time, motion.start, motion.stop) - motion.start;
}

// Where the path has carried a rest position after `seconds` in motion.
Eigen::Vector3d place(const PinMotion& motion, const Eigen::Vector3d& rest_position, double seconds) {
    if (const auto* translation = std::get_if<PinTranslation>(&motion.path); translation != nullptr)
        return rest_position + seconds * Eigen::Vector3d(translation->velocity.data());
    if (const auto* rotation = std::get_if<PinRotation>(&motion.path); rotation != nullptr) {
        const double angle = rotation->degrees_per_second * seconds * std::numbers::pi / 180.0;
        const Eigen::Vector3d axis = Eigen::Vector3d(rotation->axis.data()).stableNormalized();
        const Eigen::Vector3d center(rotation->center->data());
        return center + Eigen::AngleAxisd(angle, axis) * (rest_position - center);
    }
    return rest_position;
}

bool moves(const PinMotion& motion) {
    if (motion.stop == motion.start) return false;
    if (const auto* translation = std::get_if<PinTranslation>(&motion.path); translation != nullptr)
        return translation->velocity != std::array<double, 3>{};
    if (const auto* rotation = std::get_if<PinRotation>(&motion.path); rotation != nullptr)
        return rotation->degrees_per_second != 0.0;
    return false;
}

}  // namespace

std::vector<std::uint32_t> pinned_vertices(std::span<const PinGroup> groups) {
    std::vector<std::uint32_t> vertices;
    for (const PinGroup& group : groups) vertices.insert(vertices.end(), group.vertices.begin(), group.vertices.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

Pins::Pins(const ClothState& cloth, std::vector<PinGroup> groups) : groups_(std::move(groups)) {
    for (std::size_t index = 0; index < groups_.size(); ++index) {
        PinGroup& group = groups_[index];
        check_vertices(cloth, group, index);
        check_motion(group.motion, index);
        if (auto* rotation = std::get_if<PinRotation>(&group.motion.path); rotation != nullptr)
            rotation->center = rotation->center.value_or(centroid(cloth, group.vertices));
    }
    // Each vertex stays with the last group that names it. After the centroids: those are of all a group names.
    std::vector<bool> taken(cloth.inverse_masses.size(), false);
    for (auto group = groups_.rbegin(); group != groups_.rend(); ++group) {
        std::erase_if(group->vertices, [&](std::uint32_t vertex) {
            const bool was_taken = taken[vertex];
            taken[vertex] = true;
            return was_taken;
        });
    }
}

void Pins::set_velocities(ClothState& cloth, double time, double time_step) const {
    if (!(time_step > 0.0)) {
        throw Error(ErrorCode::invalid_argument,
                    "pins: time_step must be positive (s), got " + std::to_string(time_step));
    }
    const std::span<const double> rest_positions = cloth.rest_positions;
    const std::span<const double> positions = cloth.positions;
    const std::span<double> velocities = cloth.velocities;
    for (const PinGroup& group : groups_) {
        const double phase_before = phase(group.motion, time);
        const double phase_after = phase(group.motion, time + time_step);
        const bool at_rest = !moves(group.motion) || phase_after == phase_before;
        for (const std::uint32_t vertex : group.vertices) {
            if (at_rest) {
                vector_at(velocities, vertex).setZero();
            } else {
                const Eigen::Vector3d target = place(group.motion, vector_at(rest_positions, vertex), phase_after);
                vector_at(velocities, vertex) = (target - vector_at(positions, vertex)) / time_step;
            }
        }
    }
}

bool Pins::moving() const noexcept {
    return std::any_of(groups_.begin(), groups_.end(), [](const PinGroup& group) { return moves(group.motion); });
}

}  // namespace apsl::scenes
