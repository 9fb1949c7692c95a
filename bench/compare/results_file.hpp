// SPDX-License-Identifier: MIT
#pragma once

#include "compare/measured_run.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <span>

namespace apsl::compare {

/// How a run's deviation was measured, as it stands in the results.
struct DeviationPlan {
    ConvergedSettings settings;
    std::vector<int> frames;
};

/// Results as docs/compare.schema.json describes them: what runs were made of and what they measured. Kept whole on the
/// disk after every run.
class ResultsFile {
public:
    /// Goes on with the file where there is one. Throws InputError where it holds something else, or measurements of
    /// another machine, build or OpenCL device, or where it cannot be written.
    ResultsFile(std::filesystem::path file, const std::optional<scenes::OpenClDevice>& device);

    /// Throws InputError where the file has a scene of this name with other settings.
    void add_scene(const SceneCase& scene);

    /// Whether the run is there already, with all that is asked for, as often as RunConditions::round says. One that
    /// was timed out counts unless it may now take longer.
    bool has(const PlannedRun& run, const RunConditions& conditions,
             const std::optional<DeviationPlan>& deviation) const;

    /// In the place of an earlier one with the same settings, whose times it keeps from the second round on.
    /// `device_seconds`: a frame, of a profiled run.
    /// Returns the entry.
    nlohmann::ordered_json add(const PlannedRun& run, const MeasuredRun& measured, const RunConditions& conditions,
                               const std::optional<DeviationPlan>& deviation, std::optional<double> device_seconds);

    void write() const;

private:
    const nlohmann::ordered_json* find(const std::string& scene, const std::string& method,
                                       const ParameterValues& parameters) const;
    /// s, median of a frame's integration without a limiter: the run of `none` with as many steps; 0 where there is
    /// none.
    double integrator_seconds_without_limiter(const PlannedRun& run) const;

    std::filesystem::path file_;
    std::string commit_;
    nlohmann::ordered_json document_;
};

}  // namespace apsl::compare
