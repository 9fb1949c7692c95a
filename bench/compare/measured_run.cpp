// SPDX-License-Identifier: MIT
#include "compare/measured_run.hpp"

#include "compare/baseline_filter.hpp"
#include "compare/direct_filter.hpp"
#include "compare/integrating_step.hpp"
#include "methods/parameter_values.hpp"
#include "run/input_error.hpp"
#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace apsl::compare {
namespace {

methods::TetherSettings tether_settings(const PlannedRun& run, const scenes::Scene& scene) {
    const ParameterValues& values = run.prepared.parameters;
    return {.steps = methods::whole_number("small_steps", values.at("small_steps").get<double>()),
            .tether_length = values.at("tether_length").get<double>(),
            .bending = values.at("bending").get<double>(),
            .damping = values.at("damping").get<double>(),
            .gravity = Eigen::Vector3d(scene.gravity.data())};
}

SmallSteps small_steps(const PlannedRun& run, const scenes::Scene& scene) {
    const ParameterValues& values = run.prepared.parameters;
    return {.count = methods::whole_number("small_steps", values.at("small_steps").get<double>()),
            .damping = values.at("damping").get<double>(),
            .gravity = Eigen::Vector3d(scene.gravity.data())};
}

std::vector<methods::Parameter> baseline_parameters(const PlannedRun& run) {
    std::vector<methods::Parameter> parameters;
    for (const methods::ParameterInfo& parameter : run.method->baseline->parameters)
        parameters.push_back({parameter.name, run.prepared.parameters.at(parameter.name).get<double>()});
    return parameters;
}

scenes::FilterStage make_filter(const PlannedRun& run, const RunConditions& conditions, const scenes::Scene& scene,
                                const scenes::ClothState& cloth) {
    switch (run.method->kind) {
        case MethodKind::none:
        case MethodKind::springs:
            return std::monostate{};
        case MethodKind::ours:
            return scenes::make_filter_stage(scene, cloth, scenes::Backend::opencl, conditions.device,
                                             conditions.profile);
        case MethodKind::direct:
            return make_direct_filter(cloth, scene.strain_limiting.value());
        case MethodKind::tethers:
            return make_tethers_step(tether_settings(run, scene), cloth, scene.time_step);
        case MethodKind::small_steps:
            return make_baseline_step(*run.method->baseline, baseline_parameters(run), small_steps(run, scene), cloth,
                                      scene.time_step);
        case MethodKind::baseline:
            break;
    }
    return make_baseline_filter(*run.method->baseline, baseline_parameters(run), cloth, scene.time_step);
}

std::string device_name(scenes::FilterStage& filter) {
    if (const scenes::OpenClCloth* device = scenes::on_device(filter)) return device->device_name();
    if (const auto* custom = std::get_if<scenes::CustomFilter>(&filter)) return custom->device;
    if (const auto* step = std::get_if<scenes::CustomStep>(&filter)) return step->device;
    return "none";
}

void add_displacement(const scenes::ClothState& cloth, int frame, int frames, MeasuredRun& result) {
    const int first = frames - (frames + 3) / 4;
    if (frame < first) return;
    const std::array<double, 3> now = mean_displacement(cloth);
    for (std::size_t k = 0; k < 3; ++k) result.mean_displacement[k] += now[k] / (frames - first);
}

void measure_cloth(const scenes::ClothState& cloth, int frame, const RunConditions& conditions, MeasuredRun& result) {
    const scenes::PrincipalStretch stretch = scenes::range_of(scenes::principal_stretches(cloth));
    result.principal_stretch.min = std::min(result.principal_stretch.min, stretch.min);
    result.principal_stretch.max = std::max(result.principal_stretch.max, stretch.max);
    if (conditions.converged == nullptr) return;
    const auto expected = conditions.converged->positions.find(frame);
    if (expected != conditions.converged->positions.end())
        result.deviation.push_back({frame, deviation(cloth.positions, expected->second)});
}

}  // namespace

std::optional<MeasuredRun> measure_run(const PlannedRun& run, const RunConditions& conditions) {
    const scenes::Scene scene = scenes::parse_scene(run.prepared.document, run.scene->file);
    scenes::SceneCloth cloth = scenes::make_scene_cloth(scene);
    scenes::FilterStage filter = make_filter(run, conditions, scene, cloth.state);
    MeasuredRun result;
    result.device = device_name(filter);
    result.vertices = cloth.state.topology->vertex_count();
    result.triangles = cloth.state.topology->triangle_count();
    scenes::Simulation simulation(scene, std::move(cloth), std::move(filter), false);

    result.start_energy = simulation.energy();

    const auto start = std::chrono::steady_clock::now();
    const auto time_left = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < conditions.run_seconds;
    };
    for (int frame = 0; frame < scene.frames && !result.breakdown && !result.timed_out; ++frame) {
        if (scenes::interrupted()) return std::nullopt;
        result.frames.push_back(simulation.run_frame());
        result.breakdown = simulation.breakdown();
        if (conditions.profile) {
            if (scenes::OpenClCloth* device = scenes::on_device(simulation.filter()))
                for (const KernelTime& kernel : device->kernel_times()) result.device_seconds += kernel.seconds;
        }
        if (!result.breakdown) {
            measure_cloth(simulation.cloth(), frame, conditions, result);
            add_displacement(simulation.cloth(), frame, scene.frames, result);
        }
        if (conditions.show) conditions.show(result.frames.back());
        result.timed_out = !result.breakdown && frame + 1 < scene.frames && !time_left();
    }
    return result;
}

}  // namespace apsl::compare
