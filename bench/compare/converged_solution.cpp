// SPDX-License-Identifier: MIT
#include "compare/converged_solution.hpp"

#include "run/input_error.hpp"
#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/progress.hpp"
#include "run/simulation.hpp"
#include "run/whole_file.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace apsl::compare {
namespace {

using nlohmann::json;

// A mesh file that was edited makes another scene of the same document.
std::uint64_t fnv1a(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::uint64_t hash = 14695981039346656037u;
    for (std::istreambuf_iterator<char> byte(stream), end; byte != end; ++byte)
        hash = (hash ^ static_cast<unsigned char>(*byte)) * 1099511628211u;
    return hash;
}

json key_of(const SceneCase& scene, const scenes::Scene& parsed, const ConvergedSettings& settings) {
    json document = scene.document;
    document.erase("strain_limiting");  // has no part in it
    document.erase("frames");           // those that are asked for count
    json key{{"scene", document}, {"settings", json(to_json(settings))}};
    if (const auto* mesh = std::get_if<scenes::MeshFile>(&parsed.mesh)) key["mesh"] = fnv1a(mesh->file);
    return key;
}

std::optional<ConvergedSolution> read_cache(const std::filesystem::path& file, const json& key,
                                            std::span<const int> frames) {
    std::ifstream stream(file);
    if (!stream) return std::nullopt;
    const json stored = json::parse(stream, nullptr, false);
    if (!stored.is_object() || stored.value("key", json()) != key) return std::nullopt;
    ConvergedSolution solution;
    solution.max_area_change = stored.at("max_area_change").get<double>();
    for (const int frame : frames) {
        const auto found = stored.at("positions").find(std::to_string(frame));
        if (found == stored.at("positions").end()) return std::nullopt;
        solution.positions[frame] = found->get<std::vector<double>>();
    }
    return solution;
}

void write_cache(const std::filesystem::path& file, const json& key, const ConvergedSolution& solution) {
    json stored{{"key", key}, {"max_area_change", solution.max_area_change}, {"positions", json::object()}};
    for (const auto& [frame, positions] : solution.positions) stored["positions"][std::to_string(frame)] = positions;
    scenes::WholeFile output(file);
    output.write(stored.dump());
    output.commit();
}

scenes::Scene with_small_steps(scenes::Scene scene, const ConvergedSettings& settings) {
    scene.time_step /= settings.step_factor;
    scene.steps_per_frame *= settings.step_factor;
    scenes::StrainLimiting limiting;
    limiting.parameters = {.time_step = static_cast<float>(scene.time_step),
                           .regularization = static_cast<float>(settings.regularization),
                           .sub_steps = settings.sub_steps,
                           .target_area_change = static_cast<float>(settings.target_area_change),
                           .tolerance = static_cast<float>(settings.tolerance),
                           .max_iterations = 5000,
                           .stepping = Stepping::whole_step};
    scene.strain_limiting = limiting;
    return scene;
}

}  // namespace

nlohmann::ordered_json to_json(const ConvergedSettings& settings) {
    return {{"step_factor", settings.step_factor},
            {"sub_steps", settings.sub_steps},
            {"regularization", settings.regularization},
            {"tolerance", settings.tolerance},
            {"target_area_change", settings.target_area_change}};
}

std::optional<ConvergedSolution> converged_solution(const SceneCase& scene, const ConvergedSettings& settings,
                                                    std::span<const int> frames, const std::filesystem::path& cache) {
    const scenes::Scene parsed = scenes::parse_scene(scene.document, scene.file);
    if (std::holds_alternative<scenes::StandAloneIntegrator>(parsed.integrator))
        throw scenes::InputError(scene.name +
                                 ": a converged solution is of a filter, expected a scene whose integrator "
                                 "is not stand_alone");
    const json key = key_of(scene, parsed, settings);
    if (auto cached = read_cache(cache, key, frames)) return cached;

    const scenes::Scene small_steps = with_small_steps(parsed, settings);
    scenes::SceneCloth cloth = scenes::make_scene_cloth(small_steps);
    scenes::FilterStage filter = scenes::ReferenceFilter(cloth.state, *small_steps.strain_limiting);
    scenes::Simulation simulation(small_steps, std::move(cloth), std::move(filter), false);
    const int last = frames.empty() ? -1 : *std::max_element(frames.begin(), frames.end());
    scenes::Progress progress(last + 1);
    ConvergedSolution solution;
    for (int frame = 0; frame <= last; ++frame) {
        if (scenes::interrupted()) return std::nullopt;
        const scenes::FrameReport report = simulation.run_frame();
        if (simulation.breakdown()) {
            throw scenes::InputError(scene.name + ": the converged solution broke down in frame " +
                                     std::to_string(frame) + ": raise its step_factor or regularization");
        }
        solution.max_area_change = std::max(solution.max_area_change, report.max_area_change);
        progress.show(report);
        if (std::find(frames.begin(), frames.end(), frame) != frames.end())
            solution.positions[frame] = simulation.cloth().positions;
    }
    write_cache(cache, key, solution);
    return solution;
}

}  // namespace apsl::compare
