// SPDX-License-Identifier: MIT
#include "compare/integrating_step.hpp"

#include "compare/method_cloth.hpp"
#include "methods/parameter_values.hpp"
#include "pipeline/geometry.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace apsl::compare {
namespace {

using Vectors = std::vector<Eigen::Vector3f>;

/// `Method` has advance(positions, velocities).
template <class Method>
struct IntegratingStep {
    std::shared_ptr<Method> method;  // shared, for std::function copies what it holds
    double time_step;
    Vectors positions{}, velocities{};

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

template <class Method>
scenes::CustomStep integrating_step(std::string name, std::shared_ptr<Method> method, double time_step) {
    return {.name = std::move(name),
            .device = "this processor",
            .step = IntegratingStep<Method>{.method = std::move(method), .time_step = time_step}};
}

struct BaselineInSmallSteps {
    std::unique_ptr<methods::Method> method;
    std::vector<bool> pinned;
    int count;
    float step_length;     // s
    float kept;            // of a velocity, after a small step's damping
    Eigen::Vector3f push;  // m/s, gravity in a small step
    Vectors predicted{};

    void advance(std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> velocities) {
        for (int step = 0; step < count; ++step) {
            for (std::size_t v = 0; v < positions.size(); ++v) {
                if (!pinned[v]) velocities[v] = kept * (velocities[v] + push);
                positions[v] += step_length * velocities[v];
            }
            predicted.assign(positions.begin(), positions.end());
            method->project(positions);
            for (std::size_t v = 0; v < positions.size(); ++v)
                if (!pinned[v]) velocities[v] += (positions[v] - predicted[v]) / step_length;
        }
    }
};

}  // namespace

scenes::CustomStep make_tethers_step(const methods::TetherSettings& settings, const scenes::ClothState& cloth,
                                     double time_step) {
    return integrating_step("tethers",
                            std::make_shared<methods::TetheredDistances>(as_method_cloth(cloth, time_step), settings),
                            time_step);
}

scenes::CustomStep make_baseline_step(const methods::MethodInfo& method, std::span<const methods::Parameter> parameters,
                                      const SmallSteps& steps, const scenes::ClothState& cloth, double time_step) {
    methods::require_between("small_steps", steps.count, 1.0, 1e6);
    const double step_length = time_step / steps.count;
    auto small_steps = std::make_shared<BaselineInSmallSteps>(BaselineInSmallSteps{
        .method = methods::make_method(method.name, as_method_cloth(cloth, step_length), parameters),
        .pinned = {},
        .count = steps.count,
        .step_length = static_cast<float>(step_length),
        .kept = static_cast<float>(std::exp(-steps.damping * step_length)),
        .push = (step_length * steps.gravity).cast<float>()});
    for (const double inverse_mass : cloth.inverse_masses) small_steps->pinned.push_back(inverse_mass == 0.0);
    return integrating_step(method.name, std::move(small_steps), time_step);
}

}  // namespace apsl::compare
