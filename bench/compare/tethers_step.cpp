// SPDX-License-Identifier: MIT
#include "compare/tethers_step.hpp"

#include "compare/method_cloth.hpp"
#include "pipeline/geometry.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace apsl::compare {
namespace {

struct TethersStep {
    std::shared_ptr<methods::TetheredDistances> method;  // shared, for std::function copies what it holds
    double time_step;
    std::vector<Eigen::Vector3f> positions, velocities;

    Stats operator()(scenes::ClothState& cloth) {
        Stats stats{};
        stats.status = Status::diverged;
        positions.resize(cloth.inverse_masses.size());
        velocities.resize(positions.size());
        for (std::size_t v = 0; v < positions.size(); ++v) {
            positions[v] = scenes::vector_at(std::span<const double>(cloth.positions), v).cast<float>();
            velocities[v] = scenes::vector_at(std::span<const double>(cloth.velocities), v).cast<float>();
        }
        if (!all_finite(positions) || !all_finite(velocities)) return stats;
        method->advance(positions, velocities);
        if (!all_finite(positions) || !all_finite(velocities)) return stats;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            auto position = scenes::vector_at(std::span<double>(cloth.positions), v);
            auto velocity = scenes::vector_at(std::span<double>(cloth.velocities), v);
            if (cloth.inverse_masses[v] == 0.0) {
                position += time_step * velocity;  // keeps its 64 bits where it stands
                continue;
            }
            position = positions[v].cast<double>();
            velocity = velocities[v].cast<double>();
        }
        stats.status = Status::ok;
        return stats;
    }
};

}  // namespace

scenes::CustomStep make_tethers_step(const methods::TetherSettings& settings, const scenes::ClothState& cloth,
                                     double time_step) {
    auto method = std::make_shared<methods::TetheredDistances>(as_method_cloth(cloth, time_step), settings);
    return {
        .name = "tethers",
        .device = "this processor",
        .step = TethersStep{.method = std::move(method), .time_step = time_step, .positions = {}, .velocities = {}}};
}

}  // namespace apsl::compare
