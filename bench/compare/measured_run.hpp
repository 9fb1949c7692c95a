// SPDX-License-Identifier: MIT
#pragma once

#include "compare/compared_methods.hpp"
#include "compare/converged_solution.hpp"
#include "compare/measures.hpp"
#include "pipeline/measures.hpp"
#include "run/opencl_devices.hpp"
#include "run/report.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace apsl::compare {

/// One method with one set of parameters on one scene.
struct PlannedRun {
    const SceneCase* scene;
    const ComparedMethod* method;
    PreparedScene prepared;
};

/// How a run is made and what is looked at besides.
struct RunConditions {
    std::optional<scenes::OpenClDevice> device;  ///< for MethodKind::ours
    double run_seconds = 120.0;                  ///< no frame is begun after so long, set-up apart
    int round = 1;                               ///< 2 for the second time that all runs are made, and so on
    bool keep_frames = false;                    ///< the greatest area change of every frame in the results
    bool profile = false;                        ///< device times: a run whose times are not to be compared
    const ConvergedSolution* converged = nullptr;
    std::function<void(const scenes::FrameReport&)> show;  ///< after each frame
};

struct FrameDeviation {
    int frame;
    Deviation deviation;
};

struct MeasuredRun {
    std::vector<scenes::FrameReport> frames;
    std::string device;  ///< what the limiter ran on, "none" without one
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    scenes::PrincipalStretch principal_stretch;  ///< over all ends of frames
    std::vector<FrameDeviation> deviation;
    scenes::Energy start_energy;  ///< before the first step
    std::array<double, 3>
        mean_displacement{};  ///< m, measures.hpp, mean over the ends of the last quarter of the frames
    std::optional<scenes::Breakdown> breakdown;
    bool timed_out = false;
    double device_seconds = 0.0;  ///< all kernels, all frames; only with RunConditions::profile
};

/// None where it was interrupted. Throws InputError and Error for scenes and parameters that cannot be run.
std::optional<MeasuredRun> measure_run(const PlannedRun& run, const RunConditions& conditions);

}  // namespace apsl::compare
