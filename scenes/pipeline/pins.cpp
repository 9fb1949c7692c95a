// SPDX-License-Identifier: MIT
#include "pipeline/pins.hpp"

#include "pipeline/geometry.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace apsl::scenes {

namespace {

[[noreturn]] void fail(std::size_t group, const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "pin group " + std::to_string(group) + ": " + what);
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
        if (const std::string fault = fault_of(group.motion); !fault.empty()) fail(index, fault);
        if (auto* rotation = std::get_if<Rotation>(&group.motion.path); rotation != nullptr)
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
        const double before = seconds_in_motion(group.motion, time);
        const double after = seconds_in_motion(group.motion, time + time_step);
        const bool at_rest = !moves(group.motion) || after == before;
        for (const std::uint32_t vertex : group.vertices) {
            if (at_rest) {
                vector_at(velocities, vertex).setZero();
            } else {
                const double* rest = rest_positions.data() + 3 * vertex;
                const std::array<double, 3> target = carried(group.motion, {rest[0], rest[1], rest[2]}, after);
                vector_at(velocities, vertex) =
                    (Eigen::Vector3d(target.data()) - vector_at(positions, vertex)) / time_step;
            }
        }
    }
}

bool Pins::moving() const noexcept {
    return std::any_of(groups_.begin(), groups_.end(), [](const PinGroup& group) { return moves(group.motion); });
}

}  // namespace apsl::scenes
