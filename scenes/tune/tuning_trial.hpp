// SPDX-License-Identifier: MIT
#pragma once

#include "run/opencl_devices.hpp"
#include "run/scene.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace apsl::scenes {

/// What tuning may change of a scene.
struct LimiterSettings {
    int steps_per_frame = 1;  ///< a frame keeps its length
    StrainLimiting limiting;  ///< its time step is not looked at

    bool operator==(const LimiterSettings&) const = default;
};

/// The settings a scene has, the library's defaults where it names none; the solver is resolved.
LimiterSettings limiter_settings(const Scene& scene);

/// The document of a scene whose settings are `before`, with these: what is the same keeps its words and its order.
nlohmann::ordered_json with_settings(nlohmann::ordered_json document, const LimiterSettings& before,
                                     const LimiterSettings& settings);

/// What a run of a scene came to.
struct Trial {
    LimiterSettings settings;
    int frames = 0;                ///< run
    double max_area_change = 0.0;  ///< over frames; infinite where the scene broke down
    /// Greatest principal stretch over the frames after settling_frames, over all where there are no more; infinite
    /// where the scene broke down. Under one ceiling for all triangles what the limiter left, as areas are; else what
    /// there was at the ends of steps, contact included.
    double max_stretch = 1.0;
    double limiter_seconds = 0.0;     ///< first quartile a frame, transfers included
    double rest_seconds = 0.0;        ///< first quartile a frame, of integration and collision
    bool cut_short = false;           ///< by `enough`
    std::vector<double> positions{};  ///< m, [3V], at the end

    double seconds() const { return limiter_seconds + rest_seconds; }
};

/// Runs the scene that `document` describes over `frames` frames, or until `enough` says so after one of them.
/// None where it was interrupted. Throws InputError and Error.
std::optional<Trial> run_trial(const nlohmann::ordered_json& document, const std::string& file, int frames,
                               const std::optional<OpenClDevice>& device,
                               const std::function<bool(const Trial&)>& enough);

}  // namespace apsl::scenes
