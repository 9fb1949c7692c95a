// SPDX-License-Identifier: MIT
#include "tune/tuning_search.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace apsl::scenes {
namespace {

constexpr std::array kSubSteps{1, 2, 3, 5, 8, 12, 20, 32, 50};

// What a number of sub-steps is tried with: α of the first one, 0 where all are alike, and of the last; small steps
// need tighter solves.
struct Scheme {
    bool small_steps;
    double first, last;
};
constexpr std::array kSchemes{Scheme{false, 0.0, 1.2},   Scheme{false, 0.0, 1.1},   Scheme{false, 0.0, 1.05},
                              Scheme{false, 0.0, 1.02},  Scheme{false, 0.0, 1.01},  Scheme{false, 1.02, 1.2},
                              Scheme{false, 1.005, 1.2}, Scheme{false, 1.005, 2.0}, Scheme{true, 0.0, 1.2},
                              Scheme{true, 1.1, 1.4},    Scheme{true, 0.0, 1.05}};
constexpr double kSmallStepsTolerance = 0.03;
constexpr std::array kStepFactors{1, 2, 4, 8};
constexpr std::size_t kMaxConfirmations = 6;

struct Interrupted {};

void set_sub_steps(LimiterSettings& settings, int sub_steps) {
    settings.sub_steps = sub_steps;
    // Small steps gain little from them.
    settings.kept_pressures = settings.first_regularization > 0.0 && settings.stepping != "small_steps" ? sub_steps : 0;
}

class Search {
public:
    Search(const TuningGoal& goal, const LimiterSettings& given, int frames, const TrialRun& run)
        : goal_(goal),
          given_(given),
          frames_(frames),
          search_frames_(std::min(frames, std::max(30, frames / 4))),
          run_(run) {}

    std::optional<Trial> best(bool tune_regularization) {
        try {
            try_settings(given_);
            for (const int factor : kStepFactors) {
                if (!search_with_steps(factor * given_.steps_per_frame, tune_regularization)) break;
            }
            refine();
            return confirm();
        } catch (const Interrupted&) {
            return std::nullopt;
        }
    }

private:
    const Trial& try_settings(const LimiterSettings& settings) {
        const auto known = std::find_if(trials_.begin(), trials_.end(),
                                        [&](const Trial& trial) { return trial.settings == settings; });
        if (known != trials_.end()) return *known;
        std::optional<Trial> trial =
            run_(settings, search_frames_, [this](const Trial& so_far) { return is_hopeless(so_far); });
        if (!trial) throw Interrupted{};
        trials_.push_back(std::move(*trial));
        share_rest_seconds(trials_.back().settings.steps_per_frame);
        const Trial& done = trials_.back();
        if (!done.cut_short && (!best_ || goal_.better(done, *best_))) best_ = done;
        return done;
    }

    // The limiter has no part in the time of the rest: what differs between trials of as many steps is noise, which
    // must not choose among them.
    void share_rest_seconds(int steps_per_frame) {
        const auto alike = [&](const Trial& trial) { return trial.settings.steps_per_frame == steps_per_frame; };
        double least = trials_.back().rest_seconds;
        for (const Trial& trial : trials_) {
            if (alike(trial)) least = std::min(least, trial.rest_seconds);
        }
        for (Trial& trial : trials_) {
            if (alike(trial)) trial.rest_seconds = least;
        }
        if (best_ && alike(*best_)) best_->rest_seconds = least;
    }

    // Neither the target nor the best so far can be reached any more, or only at far more than it may cost.
    bool is_hopeless(const Trial& trial) const {
        if (!best_ || !goal_.within_budget(*best_)) return false;
        if (!goal_.meets_target(trial) && trial.max_area_change >= best_->max_area_change) return true;
        if (trial.frames < 10) return false;
        if (goal_.budget_seconds && trial.limiter_seconds > 1.5 * *goal_.budget_seconds) return true;
        return goal_.meets_target(*best_) && trial.seconds() > 2.0 * best_->seconds();
    }

    // Whether more sub-steps are what these settings lack.
    bool needs_more(const LimiterSettings& settings) {
        const Trial& trial = try_settings(settings);
        rest_seconds_ = trial.rest_seconds;
        return !goal_.meets_target(trial) && goal_.within_budget(trial);
    }

    static LimiterSettings with_scheme(LimiterSettings settings, const Scheme& scheme) {
        settings.first_regularization = scheme.first;
        settings.regularization = scheme.last;
        settings.stepping = scheme.small_steps ? "small_steps" : "whole_step";
        if (scheme.small_steps) settings.tolerance = kSmallStepsTolerance;
        return settings;
    }

    // The fewest sub-steps that meet the target, for each scheme. False where more steps cannot pay.
    bool search_with_steps(int steps_per_frame, bool tune_regularization) {
        LimiterSettings given = given_;
        given.steps_per_frame = steps_per_frame;
        std::vector<LimiterSettings> starts;
        if (tune_regularization)
            for (const Scheme& scheme : kSchemes) starts.push_back(with_scheme(given, scheme));
        else
            starts.push_back(given);
        auto place = static_cast<std::ptrdiff_t>(kSubSteps.size() / 2);
        for (LimiterSettings& settings : starts) {
            const auto misses = [&](std::ptrdiff_t at) {
                set_sub_steps(settings, kSubSteps[static_cast<std::size_t>(at)]);
                return needs_more(settings);
            };
            const auto last = static_cast<std::ptrdiff_t>(kSubSteps.size()) - 1;
            if (misses(place)) {
                while (place < last && misses(++place)) continue;
            } else {
                while (place > 0 && !misses(place - 1)) --place;
            }
            // All else of a frame costs more by now than the best in all.
            if (reached() && rest_seconds_ > best_->seconds()) return false;
        }
        return true;
    }

    bool reached() const { return best_ && goal_.meets_target(*best_) && goal_.within_budget(*best_); }

    // Around the best: looser and tighter solves.
    void refine() {
        for (int round = 0; round < 2; ++round) {
            const LimiterSettings centre = best_->settings;
            for (const double tolerance : {0.3, 0.2, 0.1, 0.03, 0.02}) {
                LimiterSettings settings = centre;
                settings.tolerance = tolerance;
                try_settings(settings);
            }
            for (const int max_iterations : {8, 16, 32, 100}) {
                LimiterSettings settings = best_->settings;
                settings.max_iterations = max_iterations;
                try_settings(settings);
            }
            if (best_->settings == centre) return;
        }
    }

    Trial confirm() {
        if (search_frames_ == frames_) return *best_;
        std::vector<Trial> candidates;
        for (const Trial& trial : trials_) {
            if (!trial.cut_short) candidates.push_back(trial);
        }
        std::sort(candidates.begin(), candidates.end(),
                  [this](const Trial& a, const Trial& b) { return goal_.better(a, b); });
        candidates.resize(std::min(candidates.size(), kMaxConfirmations));
        std::optional<Trial> confirmed;
        for (const Trial& candidate : candidates) {
            add_confirmation(candidate.settings, confirmed);
            if (goal_.meets_target(*confirmed) && goal_.within_budget(*confirmed)) return *confirmed;
        }
        // The rest of the scene is harder than its start: more sub-steps, as long as there are more.
        for (const int sub_steps : kSubSteps) {
            if (sub_steps <= candidates.front().settings.sub_steps) continue;
            LimiterSettings settings = candidates.front().settings;
            set_sub_steps(settings, sub_steps);
            add_confirmation(settings, confirmed);
            if (goal_.meets_target(*confirmed) && goal_.within_budget(*confirmed)) break;
        }
        return *confirmed;
    }

    void add_confirmation(const LimiterSettings& settings, std::optional<Trial>& confirmed) {
        std::optional<Trial> trial = run_(settings, frames_, [&](const Trial& so_far) {
            return confirmed && !goal_.meets_target(so_far) && so_far.max_area_change >= confirmed->max_area_change;
        });
        if (!trial) throw Interrupted{};
        if (!trial->cut_short && (!confirmed || goal_.better(*trial, *confirmed))) confirmed = std::move(*trial);
    }

    const TuningGoal& goal_;
    LimiterSettings given_;
    int frames_;
    int search_frames_;
    const TrialRun& run_;
    std::vector<Trial> trials_;
    std::optional<Trial> best_;
    double rest_seconds_ = 0.0;
};

}  // namespace

bool TuningGoal::better(const Trial& trial, const Trial& other) const {
    if (within_budget(trial) != within_budget(other)) return within_budget(trial);
    if (meets_target(trial) != meets_target(other)) return meets_target(trial);
    // Beyond the budget the way back to it counts.
    if (!within_budget(trial)) return trial.limiter_seconds < other.limiter_seconds;
    return meets_target(trial) ? trial.seconds() < other.seconds() : trial.max_area_change < other.max_area_change;
}

std::optional<Trial> search_settings(const TuningGoal& goal, const LimiterSettings& given, bool tune_regularization,
                                     int frames, const TrialRun& run) {
    return Search(goal, given, frames, run).best(tune_regularization);
}

}  // namespace apsl::scenes
