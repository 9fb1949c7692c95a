// SPDX-License-Identifier: MIT
#include "tune/tuning_trial.hpp"

#include "fields.hpp"
#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_document.hpp"
#include "run/settled.hpp"
#include "run/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

namespace apsl::scenes {
namespace {

// First quartile. Whatever else the machine does only adds to a time, and must not choose among settings.
double quiet_time(std::vector<double> seconds) {
    const auto place = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 4);
    std::nth_element(seconds.begin(), place, seconds.end());
    return *place;
}

// A tuned scene names these whatever they are, so that later defaults do not change it.
bool is_always_written(std::string_view name) {
    constexpr std::string_view names[] = {"sub_steps", "regularization", "tolerance", "max_iterations"};
    return std::ranges::find(names, name) != std::end(names);
}

template <class Value>
nlohmann::ordered_json json_of(Value value) {
    if constexpr (std::is_enum_v<Value>)
        return std::string(name_of(value));
    else if constexpr (std::is_floating_point_v<Value>)
        return shortest(value);
    else
        return value;
}

double stretch_of(const FrameReport& frame, const StrainLimiting& limiting) {
    if (!limiting.options.limits_stretch || limiting.options.stretch_ceiling_per_triangle)
        return frame.max_principal_stretch;
    const auto ceiling = static_cast<double>(limiting.parameters.stretch_ceiling);
    return frame.max_stretch_excess > 0.0 ? ceiling + frame.max_stretch_excess
                                          : std::min(frame.max_principal_stretch, ceiling);
}

}  // namespace

LimiterSettings limiter_settings(const Scene& scene) {
    LimiterSettings settings{.steps_per_frame = scene.steps_per_frame,
                             .limiting = scene.strain_limiting.value_or(StrainLimiting{})};
    settings.limiting.parameters.time_step = Parameters{}.time_step;
    settings.limiting.options.solver = resolved_solver(settings.limiting.options);
    return settings;
}

nlohmann::ordered_json with_settings(nlohmann::ordered_json document, const LimiterSettings& before,
                                     const LimiterSettings& settings) {
    set_steps_per_frame(document, settings.steps_per_frame);
    nlohmann::ordered_json& limiting = document["strain_limiting"];
    if (limiting.is_null()) limiting = nlohmann::ordered_json::object();
    const auto write = [&](const auto& field, const auto& old, const auto& now) {
        const std::string_view name = field.name;
        if (!field.in_scenes) return;
        if (now.*field.member == old.*field.member && !is_always_written(name)) return;
        // A list of α stays.
        if (name == "regularization" && settings.limiting.options.regularization_per_triangle) return;
        limiting[field.name] = json_of(now.*field.member);
    };
    for_each_field(parameter_fields,
                   [&](const auto& field) { write(field, before.limiting.parameters, settings.limiting.parameters); });
    for_each_field(option_fields,
                   [&](const auto& field) { write(field, before.limiting.options, settings.limiting.options); });
    return document;
}

std::optional<Trial> run_trial(const nlohmann::ordered_json& document, const std::string& file, int frames,
                               const std::optional<OpenClDevice>& device,
                               const std::function<bool(const Trial&)>& enough) {
    const Scene scene = parse_scene(nlohmann::json(document), file);
    SceneCloth cloth = make_scene_cloth(scene);
    FilterStage filter = make_filter_stage(scene, cloth.state, Backend::opencl, device, false);
    Simulation simulation(scene, std::move(cloth), std::move(filter), false);
    Trial trial{.settings = limiter_settings(scene)};
    const int settling = frames > static_cast<int>(settling_frames) ? static_cast<int>(settling_frames) : 0;
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
        if (trial.frames > settling)
            trial.max_stretch = std::max(trial.max_stretch, stretch_of(frame, trial.settings.limiting));
        if (simulation.breakdown()) {
            trial.max_area_change = trial.max_stretch = std::numeric_limits<double>::infinity();
            break;
        }
        trial.cut_short = trial.frames < frames && enough(trial);
    }
    trial.positions = simulation.cloth().positions;
    return trial;
}

}  // namespace apsl::scenes
