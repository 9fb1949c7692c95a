// SPDX-License-Identifier: MIT
#include "tune/tuning_search.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace apsl::scenes {
namespace {

constexpr std::array tried_sub_steps{1, 2, 3, 5, 8, 12, 20, 32, 50};

// What a number of sub-steps is tried with: α of the first one, 0 where all are alike, and of the last.
struct Scheme {
    Solver solver;
    Stepping stepping;
    float first, last;
};
constexpr auto cg = Solver::conjugate_gradient;
constexpr auto chebyshev = Solver::chebyshev;
constexpr auto whole_step = Stepping::whole_step;
constexpr auto small_steps = Stepping::small_steps;
constexpr std::array all_schemes{
    Scheme{cg, whole_step, 0.0f, 1.2f},          Scheme{cg, whole_step, 0.0f, 1.1f},
    Scheme{cg, whole_step, 0.0f, 1.05f},         Scheme{cg, whole_step, 0.0f, 1.02f},
    Scheme{cg, whole_step, 0.0f, 1.01f},         Scheme{cg, whole_step, 1.02f, 1.2f},
    Scheme{cg, whole_step, 1.005f, 1.2f},        Scheme{cg, whole_step, 1.005f, 2.0f},
    Scheme{cg, small_steps, 0.0f, 1.2f},         Scheme{cg, small_steps, 1.1f, 1.4f},
    Scheme{cg, small_steps, 0.0f, 1.05f},        Scheme{chebyshev, small_steps, 0.0f, 1.2f},
    Scheme{chebyshev, small_steps, 0.0f, 1.05f}, Scheme{chebyshev, whole_step, 1.01f, 1.2f}};
// Under a stretch ceiling, which needs small steps by Chebyshev.
constexpr std::array ceiling_schemes{Scheme{chebyshev, small_steps, 0.0f, 1.2f},
                                     Scheme{chebyshev, small_steps, 0.0f, 1.1f},
                                     Scheme{chebyshev, small_steps, 0.0f, 1.05f}};
constexpr std::ptrdiff_t least_under_ceiling = 1;  // of tried_sub_steps: small steps are 2 at least
// Of the stretch asked for: what is stated is met nearly. The lower one first, for it is met sooner.
constexpr std::array ceiling_shares{0.75, 0.95};
constexpr float small_steps_tolerance = 0.03f;  // CG: they need tighter solves
constexpr std::array step_factors{1, 2, 4, 8};
constexpr std::size_t max_confirmations = 6;

struct Interrupted {};

void set_sub_steps(LimiterSettings& settings, int sub_steps) {
    Options& options = settings.limiting.options;
    Parameters& parameters = settings.limiting.parameters;
    parameters.sub_steps = sub_steps;
    if (parameters.most_sub_steps > 0) parameters.most_sub_steps = std::max(parameters.most_sub_steps, sub_steps);
    // Small steps gain little from them.
    const bool pays = parameters.first_regularization > 0.0f && parameters.stepping != small_steps;
    options.warm_start_sub_steps = pays && options.solver == cg ? static_cast<std::uint32_t>(sub_steps) : 0;
}

// Whether a limiter takes them.
bool are_legal(const LimiterSettings& settings) {
    try {
        validate(settings.limiting.options, settings.limiting.parameters);
    } catch (const Error&) {
        return false;
    }
    return true;
}

class Search {
public:
    Search(const TuningGoal& goal, const LimiterSettings& given, const TuningFreedom& freedom, int frames,
           const TrialRun& run)
        : goal_(goal),
          given_(given),
          freedom_(freedom),
          frames_(frames),
          search_frames_(std::min(frames, std::max(30, frames / 4))),
          run_(run) {}

    std::optional<Trial> best() {
        try {
            try_settings(given_);
            for (const int factor : step_factors)
                if (!search_with_steps(factor * given_.steps_per_frame)) break;
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
        for (const Trial& trial : trials_)
            if (alike(trial)) least = std::min(least, trial.rest_seconds);
        for (Trial& trial : trials_)
            if (alike(trial)) trial.rest_seconds = least;
        if (best_ && alike(*best_)) best_->rest_seconds = least;
    }

    // Neither the target nor the best so far can be reached any more, or only at far more than it may cost.
    bool is_hopeless(const Trial& trial) const {
        if (!best_ || !goal_.within_budget(*best_)) return false;
        if (!goal_.meets_target(trial) && goal_.miss(trial) >= goal_.miss(*best_)) return true;
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
        Parameters& parameters = settings.limiting.parameters;
        settings.limiting.options.solver = scheme.solver;
        parameters.first_regularization = scheme.first;
        parameters.regularization = scheme.last;
        parameters.stepping = scheme.stepping;
        if (scheme.stepping == small_steps && scheme.solver == cg) parameters.tolerance = small_steps_tolerance;
        return settings;
    }

    // What to start from: the schemes that leave alone what is to stay, or what is given.
    std::vector<LimiterSettings> starts(int steps_per_frame) const {
        LimiterSettings given = given_;
        given.steps_per_frame = steps_per_frame;
        if (!freedom_.regularization) return {given};
        std::vector<LimiterSettings> all;
        const auto add = [&](const LimiterSettings& base, const Scheme& scheme) {
            LimiterSettings settings = with_scheme(base, scheme);
            set_sub_steps(settings, tried_sub_steps[static_cast<std::size_t>(least_place(settings))]);
            const bool same_solver = scheme.solver == given.limiting.options.solver;
            if ((freedom_.solver || same_solver) && are_legal(settings)) all.push_back(settings);
        };
        if (areas_alone_may_do())
            for (const Scheme& scheme : all_schemes) add(given, scheme);
        for (const LimiterSettings& base : under_ceilings(given))
            for (const Scheme& scheme : ceiling_schemes) add(base, scheme);
        return all;
    }

    static std::ptrdiff_t least_place(const LimiterSettings& settings) {
        return settings.limiting.options.limits_stretch ? least_under_ceiling : 0;
    }

    // More of what limits areas does not shorten what areas let grow long.
    bool areas_alone_may_do() const {
        return !given_.limiting.options.limits_stretch && goal_.meets_stretch(trials_.front());
    }

    // With the ceiling that is given, or with those that the stretch asked for suggests.
    std::vector<LimiterSettings> under_ceilings(const LimiterSettings& given) const {
        std::vector<LimiterSettings> all;
        if (given.limiting.options.limits_stretch) all.push_back(given);
        if (!freedom_.ceiling || !goal_.target_stretch) return all;
        for (const double share : ceiling_shares) {
            LimiterSettings settings = given;
            settings.limiting.options.limits_stretch = true;
            settings.limiting.options.bound_interval = 1;
            settings.limiting.parameters.stretch_ceiling =
                static_cast<float>(1.0 + share * (*goal_.target_stretch - 1.0));
            if (std::ranges::find(all, settings) == all.end()) all.push_back(settings);
        }
        return all;
    }

    // The fewest sub-steps that meet the target, for each scheme. False where more steps cannot pay.
    bool search_with_steps(int steps_per_frame) {
        auto place = static_cast<std::ptrdiff_t>(tried_sub_steps.size() / 2);
        for (LimiterSettings& settings : starts(steps_per_frame)) {
            const std::ptrdiff_t first = least_place(settings);
            place = std::max(place, first);
            const auto misses = [&](std::ptrdiff_t at) {
                set_sub_steps(settings, tried_sub_steps[static_cast<std::size_t>(at)]);
                return needs_more(settings);
            };
            const auto last = static_cast<std::ptrdiff_t>(tried_sub_steps.size()) - 1;
            if (misses(place))
                while (place < last && misses(++place)) continue;
            else
                while (place > first && !misses(place - 1)) --place;
            // All else of a frame costs more by now than the best in all.
            if (reached() && rest_seconds_ > best_->seconds()) return false;
        }
        return true;
    }

    bool reached() const { return best_ && goal_.meets_target(*best_) && goal_.within_budget(*best_); }

    // Around the best: looser and tighter solves. A polynomial has no tolerance.
    void refine() {
        for (int round = 0; round < 2; ++round) {
            const LimiterSettings centre = best_->settings;
            if (centre.limiting.options.solver == chebyshev) return;
            for (const float tolerance : {0.3f, 0.2f, 0.1f, 0.03f, 0.02f}) {
                LimiterSettings settings = centre;
                settings.limiting.parameters.tolerance = tolerance;
                try_settings(settings);
            }
            for (const int max_iterations : {8, 16, 32, 100}) {
                LimiterSettings settings = best_->settings;
                settings.limiting.parameters.max_iterations = max_iterations;
                try_settings(settings);
            }
            if (best_->settings == centre) return;
        }
    }

    Trial confirm() {
        if (search_frames_ == frames_) return *best_;
        std::vector<Trial> candidates;
        for (const Trial& trial : trials_)
            if (!trial.cut_short) candidates.push_back(trial);
        std::stable_sort(candidates.begin(), candidates.end(),
                         [this](const Trial& a, const Trial& b) { return goal_.better(a, b); });
        candidates.resize(std::min(candidates.size(), max_confirmations));
        std::optional<Trial> confirmed;
        for (const Trial& candidate : candidates) {
            add_confirmation(candidate.settings, confirmed);
            if (goal_.meets_target(*confirmed) && goal_.within_budget(*confirmed)) return *confirmed;
        }
        // The rest of the scene is harder than its start: more sub-steps, as long as there are more.
        for (const int sub_steps : tried_sub_steps) {
            if (sub_steps <= candidates.front().settings.limiting.parameters.sub_steps) continue;
            LimiterSettings settings = candidates.front().settings;
            set_sub_steps(settings, sub_steps);
            add_confirmation(settings, confirmed);
            if (goal_.meets_target(*confirmed) && goal_.within_budget(*confirmed)) break;
        }
        return *confirmed;
    }

    void add_confirmation(const LimiterSettings& settings, std::optional<Trial>& confirmed) {
        std::optional<Trial> trial = run_(settings, frames_, [&](const Trial& so_far) {
            return confirmed && !goal_.meets_target(so_far) && goal_.miss(so_far) >= goal_.miss(*confirmed);
        });
        if (!trial) throw Interrupted{};
        if (!trial->cut_short && (!confirmed || goal_.better(*trial, *confirmed))) confirmed = std::move(*trial);
    }

    const TuningGoal& goal_;
    LimiterSettings given_;
    TuningFreedom freedom_;
    int frames_;
    int search_frames_;
    const TrialRun& run_;
    std::vector<Trial> trials_;
    std::optional<Trial> best_;
    double rest_seconds_ = 0.0;
};

}  // namespace

double TuningGoal::miss(const Trial& trial) const {
    const double area = trial.max_area_change / target;
    return target_stretch ? std::max(area, (trial.max_stretch - 1.0) / (*target_stretch - 1.0)) : area;
}

bool TuningGoal::better(const Trial& trial, const Trial& other) const {
    if (within_budget(trial) != within_budget(other)) return within_budget(trial);
    if (meets_target(trial) != meets_target(other)) return meets_target(trial);
    // Beyond the budget the way back to it counts.
    if (!within_budget(trial)) return trial.limiter_seconds < other.limiter_seconds;
    return meets_target(trial) ? trial.seconds() < other.seconds() : miss(trial) < miss(other);
}

std::optional<Trial> search_settings(const TuningGoal& goal, const LimiterSettings& given, const TuningFreedom& freedom,
                                     int frames, const TrialRun& run) {
    return Search(goal, given, freedom, frames, run).best();
}

}  // namespace apsl::scenes
