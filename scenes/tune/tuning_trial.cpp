// SPDX-License-Identifier: MIT
#include "tune/tuning_trial.hpp"

#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_document.hpp"
#include "run/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace apsl::scenes {
namespace {

// First quartile. Whatever else the machine does only adds to a time, and must not choose among settings.
double quiet_time(std::vector<double> seconds) {
    const auto place = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 4);
    std::nth_element(seconds.begin(), place, seconds.end());
    return *place;
}

}  // namespace

LimiterSettings limiter_settings(const nlohmann::ordered_json& document) {
    const Parameters standard;
    const Scene scene;
    const nlohmann::ordered_json limiting = document.value("strain_limiting", nlohmann::ordered_json::object());
    LimiterSettings settings;
    settings.steps_per_frame = document.value("steps_per_frame", scene.steps_per_frame);
    settings.sub_steps = limiting.value("sub_steps", standard.sub_steps);
    settings.tolerance = limiting.value("tolerance", shortest(standard.tolerance));
    settings.max_iterations = limiting.value("max_iterations", standard.max_iterations);
    settings.kept_pressures = limiting.value("kept_pressures", 0);
    settings.first_regularization = limiting.value("first_regularization", shortest(standard.first_regularization));
    settings.stepping = limiting.value("stepping", settings.stepping);
    settings.regularization = shortest(standard.regularization);
    if (limiting.contains("regularization") && limiting["regularization"].is_number()) {
        settings.regularization = limiting["regularization"].get<double>();
    }
    return settings;
}

nlohmann::ordered_json with_settings(nlohmann::ordered_json document, const LimiterSettings& settings) {
    const LimiterSettings before = limiter_settings(document);
    set_steps_per_frame(document, settings.steps_per_frame);
    nlohmann::ordered_json& limiting = document["strain_limiting"];
    if (limiting.is_null()) limiting = nlohmann::ordered_json::object();
    limiting["sub_steps"] = settings.sub_steps;
    if (!limiting.contains("regularization") || limiting["regularization"].is_number()) {
        limiting["regularization"] = settings.regularization;
    }
    if (settings.first_regularization != before.first_regularization) {
        limiting["first_regularization"] = settings.first_regularization;
    }
    if (settings.stepping != before.stepping) limiting["stepping"] = settings.stepping;
    if (settings.kept_pressures != before.kept_pressures) limiting["kept_pressures"] = settings.kept_pressures;
    limiting["tolerance"] = settings.tolerance;
    limiting["max_iterations"] = settings.max_iterations;
    return document;
}

std::optional<Trial> run_trial(const nlohmann::ordered_json& document, const std::string& file, int frames,
                               const std::optional<OpenClDevice>& device,
                               const std::function<bool(const Trial&)>& enough) {
    const Scene scene = parse_scene(nlohmann::json(document), file);
    SceneCloth cloth = make_scene_cloth(scene);
    FilterStage filter = make_filter_stage(scene, cloth.state, Backend::opencl, device, false);
    Simulation simulation(scene, std::move(cloth), std::move(filter), false);
    Trial trial{.settings = limiter_settings(document)};
    std::vector<double> limiter_seconds;
    std::vector<double> rest_seconds;
    while (trial.frames < frames && !trial.cut_short) {
        if (interrupted()) return std::nullopt;
        const FrameReport frame = simulation.run_frame();
        ++trial.frames;
        limiter_seconds.push_back(frame.filter_seconds);
        rest_seconds.push_back(frame.step_seconds - frame.filter_seconds);
        trial.limiter_seconds = quiet_time(limiter_seconds);
        trial.rest_seconds = quiet_time(rest_seconds);
        trial.max_area_change = std::max(trial.max_area_change, frame.max_area_change);
        if (simulation.breakdown()) {
            trial.max_area_change = std::numeric_limits<double>::infinity();
            break;
        }
        trial.cut_short = trial.frames < frames && enough(trial);
    }
    trial.positions = simulation.cloth().positions;
    return trial;
}

}  // namespace apsl::scenes
