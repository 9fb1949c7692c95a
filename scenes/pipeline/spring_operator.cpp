// SPDX-License-Identifier: MIT
#include "pipeline/spring_operator.hpp"

#include "pipeline/geometry.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace apsl::scenes {

namespace {

struct Stretched {
    Eigen::Vector3d direction;  ///< from a to b, zero where both lie in one place
    double length;
};

Stretched stretched(const Spring& spring, std::span<const double> positions) {
    const Eigen::Vector3d offset = vector_at(positions, spring.b) - vector_at(positions, spring.a);
    const double length = offset.norm();
    if (length > 0.0) return {.direction = offset / length, .length = length};
    return {.direction = Eigen::Vector3d::Zero(), .length = 0.0};
}

}  // namespace

double spring_energy(std::span<const Spring> springs, std::span<const double> positions) {
    double energy = 0.0;
    for (const Spring& spring : springs) {
        const double extension = stretched(spring, positions).length - spring.rest_length;
        energy += 0.5 * spring.stiffness * extension * extension;
    }
    return energy;
}

SpringOperator::SpringOperator(const ClothState& cloth, std::vector<Spring> springs)
    : springs_(std::move(springs)),
      blocks_(springs_.size()),
      inertia_(cloth.masses.size()),
      inverse_diagonal_(cloth.masses.size()) {
}

void SpringOperator::spring_forces(const ClothState& cloth, std::span<double> forces) const {
    std::fill(forces.begin(), forces.end(), 0.0);
    for (const Spring& spring : springs_) {
        // Where both ends lie in one place the spring has no direction to push in, and pushes nowhere.
        const auto [direction, length] = stretched(spring, cloth.positions);
        const Eigen::Vector3d force = spring.stiffness * (length - spring.rest_length) * direction;
        vector_at(forces, spring.a) += force;
        vector_at(forces, spring.b) -= force;
    }
}

void SpringOperator::linearize(const ClothState& cloth, double time_step, double damping) {
    for (std::size_t vertex = 0; vertex < inertia_.size(); ++vertex) {
        const bool pinned = cloth.inverse_masses[vertex] == 0.0;
        inertia_[vertex] = pinned ? 0.0 : cloth.masses[vertex] * (1.0 + time_step * damping);
        inverse_diagonal_[vertex] = {inertia_[vertex], 0.0, 0.0, inertia_[vertex], 0.0, inertia_[vertex]};
    }
    const double squared_step = time_step * time_step;
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        const Spring& spring = springs_[i];
        const auto [direction, length] = stretched(spring, cloth.positions);
        const double stiffness = squared_step * spring.stiffness;
        Block block{.axial = {}, .transverse = 0.0};
        if (spring.rest_length == 0.0) {
            block.transverse = stiffness;  // linear: the block is k I at any length
        } else if (length > 0.0) {
            block.transverse = stiffness * std::max(0.0, 1.0 - spring.rest_length / length);
            const Eigen::Vector3d axial = std::sqrt(stiffness - block.transverse) * direction;
            block.axial = {axial.x(), axial.y(), axial.z()};
        }
        blocks_[i] = block;
        const auto& [x, y, z] = block.axial;
        const Symmetric entries{x * x + block.transverse, x * y, x * z,
                                y * y + block.transverse, y * z, z * z + block.transverse};
        for (std::size_t entry = 0; entry < entries.size(); ++entry) {
            inverse_diagonal_[spring.a][entry] += entries[entry];
            inverse_diagonal_[spring.b][entry] += entries[entry];
        }
    }
    invert_diagonal();
}

void SpringOperator::invert_diagonal() {
    for (std::size_t vertex = 0; vertex < inverse_diagonal_.size(); ++vertex) {
        Symmetric& entries = inverse_diagonal_[vertex];
        if (inertia_[vertex] == 0.0) {
            entries = {};
            continue;
        }
        Eigen::Matrix3d block;
        block << entries[0], entries[1], entries[2],  //
            entries[1], entries[3], entries[4],       //
            entries[2], entries[4], entries[5];
        // Scaled to a trace of one first: the determinant of a block of very small masses would underflow.
        const double trace = block.trace();
        const Eigen::Matrix3d inverse = (block / trace).inverse() / trace;
        entries = {inverse(0, 0), inverse(0, 1), inverse(0, 2), inverse(1, 1), inverse(1, 2), inverse(2, 2)};
    }
}

// The products below are written out in scalars: they are where nearly all the time of a step goes, and a compiler
// that sees three doubles a vertex keeps them in registers.

void SpringOperator::add_stiffness(std::span<const double> vector, std::span<double> result, double sign) const {
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        const Block& block = blocks_[i];
        const std::size_t a = 3 * static_cast<std::size_t>(springs_[i].a);
        const std::size_t b = 3 * static_cast<std::size_t>(springs_[i].b);
        const double x = vector[b] - vector[a];
        const double y = vector[b + 1] - vector[a + 1];
        const double z = vector[b + 2] - vector[a + 2];
        const double along = sign * (block.axial[0] * x + block.axial[1] * y + block.axial[2] * z);
        const double transverse = sign * block.transverse;
        const double force_x = transverse * x + along * block.axial[0];
        const double force_y = transverse * y + along * block.axial[1];
        const double force_z = transverse * z + along * block.axial[2];
        result[a] += force_x;
        result[a + 1] += force_y;
        result[a + 2] += force_z;
        result[b] -= force_x;
        result[b + 1] -= force_y;
        result[b + 2] -= force_z;
    }
}

void SpringOperator::apply(std::span<const double> vector, std::span<double> result) const {
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = inertia_[i / 3] * vector[i];
    add_stiffness(vector, result, -1.0);
    clear_pinned(result);
}

void SpringOperator::clear_pinned(std::span<double> vector) const {
    for (std::size_t vertex = 0; vertex < inertia_.size(); ++vertex)
        if (inertia_[vertex] == 0.0) vector_at(vector, vertex).setZero();
}

void SpringOperator::precondition(std::span<const double> vector, std::span<double> result) const {
    for (std::size_t vertex = 0; vertex < inertia_.size(); ++vertex) {
        const Symmetric& inverse = inverse_diagonal_[vertex];
        const double x = vector[3 * vertex];
        const double y = vector[3 * vertex + 1];
        const double z = vector[3 * vertex + 2];
        result[3 * vertex] = inverse[0] * x + inverse[1] * y + inverse[2] * z;
        result[3 * vertex + 1] = inverse[1] * x + inverse[3] * y + inverse[4] * z;
        result[3 * vertex + 2] = inverse[2] * x + inverse[4] * y + inverse[5] * z;
    }
}

std::size_t SpringOperator::scratch_bytes() const noexcept {
    return springs_.size() * (sizeof(Spring) + sizeof(Block)) + inertia_.size() * (sizeof(double) + sizeof(Symmetric));
}

}  // namespace apsl::scenes
