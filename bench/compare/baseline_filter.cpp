// SPDX-License-Identifier: MIT
#include "compare/baseline_filter.hpp"

#include "compare/method_cloth.hpp"
#include "pipeline/geometry.hpp"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace apsl::compare {
namespace {

struct BaselineFilter {
    std::shared_ptr<methods::Method> method;  // shared, for std::function copies what it holds
    double time_step;
    std::vector<Eigen::Vector3f> predicted, projected;

    Stats operator()(scenes::ClothState& cloth) {
        Stats stats{};
        stats.status = Status::diverged;
        predicted.resize(cloth.inverse_masses.size());
        for (std::size_t v = 0; v < predicted.size(); ++v) {
            predicted[v] = (scenes::vector_at(std::span<const double>(cloth.positions), v) +
                            time_step * scenes::vector_at(std::span<const double>(cloth.velocities), v))
                               .cast<float>();
        }
        if (!all_finite(predicted)) return stats;
        projected = predicted;
        method->project(projected);
        if (!all_finite(projected)) return stats;
        for (std::size_t v = 0; v < predicted.size(); ++v) {
            if (cloth.inverse_masses[v] == 0.0) continue;
            // Only the correction goes into the 64-bit velocities, not the rounding of the rest to 32 bits.
            scenes::vector_at(std::span<double>(cloth.velocities), v) +=
                (projected[v].cast<double>() - predicted[v].cast<double>()) / time_step;
        }
        stats.status = Status::ok;
        return stats;
    }
};

}  // namespace

scenes::CustomFilter make_baseline_filter(const methods::MethodInfo& method,
                                          std::span<const methods::Parameter> parameters,
                                          const scenes::ClothState& cloth, double time_step) {
    std::shared_ptr<methods::Method> made =
        methods::make_method(method.name, as_method_cloth(cloth, time_step), parameters);
    return {
        .name = method.name,
        .device = "this processor",
        .filter = BaselineFilter{.method = std::move(made), .time_step = time_step, .predicted = {}, .projected = {}}};
}

}  // namespace apsl::compare
