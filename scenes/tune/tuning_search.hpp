// SPDX-License-Identifier: MIT
#pragma once

#include "tune/tuning_trial.hpp"

#include <functional>
#include <optional>

namespace apsl::scenes {

/// What the settings are to meet.
struct TuningGoal {
    double target = 0.01;                  ///< greatest |A − A⁰| / A⁰ over triangles and frames
    std::optional<double> target_stretch;  ///< greatest Trial::max_stretch, > 1
    std::optional<double> budget_seconds;  ///< of the limiter, a frame

    bool meets_stretch(const Trial& trial) const { return !target_stretch || trial.max_stretch <= *target_stretch; }
    bool meets_target(const Trial& trial) const { return trial.max_area_change <= target && meets_stretch(trial); }
    /// How far off the targets: the greater of area change and stretch beyond 1, each over what it may be.
    double miss(const Trial& trial) const;
    bool within_budget(const Trial& trial) const { return !budget_seconds || trial.limiter_seconds <= *budget_seconds; }
    /// Of two trials over as many frames: within the budget before beyond it, met before missed, and then the cheaper
    /// of two that meet the target, the closer of two that do not.
    bool better(const Trial& trial, const Trial& other) const;
};

/// What the search may change beside sub-steps, steps and how tightly systems are solved.
struct TuningFreedom {
    bool regularization = true;  ///< false where each triangle has its own: then steps and solver stay too
    bool solver = true;          ///< false where the scene names one
    bool ceiling = false;  ///< of stretch; true where a target of stretch is asked for, and no list of ceilings given
};

/// A trial of these settings over so many frames, cut short where `enough` says so; none where it was interrupted.
using TrialRun = std::function<std::optional<Trial>(const LimiterSettings& settings, int frames,
                                                    const std::function<bool(const Trial&)>& enough)>;

/// Searches over the first quarter of the frames (30 at least) for the best settings, then confirms the best on all of
/// them; what fails there makes place for the next best. Starts at `given`, the scene's own settings as
/// limiter_settings gives them.
/// None where a trial was interrupted.
std::optional<Trial> search_settings(const TuningGoal& goal, const LimiterSettings& given, const TuningFreedom& freedom,
                                     int frames, const TrialRun& run);

}  // namespace apsl::scenes
