// SPDX-License-Identifier: MIT
#include "tune/tune_command.hpp"

#include "fields.hpp"
#include "run/commands.hpp"
#include "run/input_files.hpp"
#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/whole_file.hpp"
#include "run/words.hpp"
#include "tune/scene_text.hpp"
#include "tune/tuning_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace apsl::scenes {
namespace {

using Document = nlohmann::ordered_json;

const auto to_the_end = [](const Trial&) { return false; };

// 1.075 and 1.125, where short_number has three digits. A cloth that is given up while it settles has none.
std::string stretch_text(double stretch) {
    if (stretch <= 1.0) return "-";
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", stretch);
    return text;
}

// What was tried, a line each as it is done.
class Table {
public:
    explicit Table(std::FILE* stream) : stream_(stream) {
        std::fprintf(
            stream_,
            "steps  solver              sub-steps  stepping     first α  last α  tolerance  iterations  ceiling  "
            "frames  area change  stretch  limiter ms  frame ms\n");
    }

    void add(const Trial& trial, const TuningGoal& goal) {
        const Options& options = trial.settings.limiting.options;
        const Parameters& parameters = trial.settings.limiting.parameters;
        const float last = parameters.regularization;
        const bool has_tolerance = options.solver == Solver::conjugate_gradient;
        std::fprintf(stream_,
                     "%5d  %-18s  %9d  %-11s  %7.4g  %6.4g  %9s  %10d  %7s  %6d  %9.3f %%  %7s  %10.3f  %8.3f  %s\n",
                     trial.settings.steps_per_frame, std::string(name_of(options.solver)).c_str(), parameters.sub_steps,
                     std::string(name_of(parameters.stepping)).c_str(),
                     parameters.first_regularization > 0.0f ? parameters.first_regularization : last, last,
                     has_tolerance ? short_number(parameters.tolerance).c_str() : "-", parameters.max_iterations,
                     ceiling_text(trial.settings.limiting).c_str(), trial.frames, 100.0 * trial.max_area_change,
                     stretch_text(trial.max_stretch).c_str(), 1e3 * trial.limiter_seconds, 1e3 * trial.seconds(),
                     verdict(trial, goal));
    }

    void add_without_limiter(const Trial& trial, const TuningGoal& goal) {
        std::fprintf(stream_, "%5d  %-91s %7d  %9.3f %%  %7s  %10s  %8.3f  %s\n", trial.settings.steps_per_frame,
                     "(no strain limiting)", trial.frames, 100.0 * trial.max_area_change,
                     stretch_text(trial.max_stretch).c_str(), "-", 1e3 * trial.seconds(), verdict(trial, goal));
    }

private:
    static std::string ceiling_text(const StrainLimiting& limiting) {
        if (!limiting.options.limits_stretch) return "-";
        if (limiting.options.stretch_ceiling_per_triangle) return "a list";
        return stretch_text(static_cast<double>(limiting.parameters.stretch_ceiling));
    }

    static const char* verdict(const Trial& trial, const TuningGoal& goal) {
        if (trial.cut_short) return "given up";
        if (!std::isfinite(trial.max_area_change)) return "diverged";
        if (!goal.within_budget(trial)) return "beyond the budget";
        if (goal.meets_target(trial)) return "meets the target";
        return goal.meets_stretch(trial) ? "misses" : "misses the stretch";
    }

    std::FILE* stream_;
};

struct Tuning {
    Document document;
    std::string file;
    Scene scene;  // what the document says
    TuningGoal goal;
    std::optional<OpenClDevice> device;
    std::FILE* stream;
};

std::optional<Trial> whole_run(const Tuning& tuning, const Document& document) {
    return run_trial(document, tuning.file, tuning.scene.frames, tuning.device, to_the_end);
}

// Whether the target holds when bending is left out. None: interrupted.
std::optional<bool> holds_without_bending(const Tuning& tuning, Document document) {
    document["integrator"]["implicit_springs"]["bend_stiffness"] = 0;
    const std::optional<Trial> trial = whole_run(tuning, document);
    if (!trial) return std::nullopt;
    return tuning.goal.meets_target(*trial);
}

// Without springs and the limiter there is gravity alone, which meets a target where nothing holds the cloth.
bool has_springs(const Scene& scene) {
    return std::holds_alternative<ImplicitSpringsIntegrator>(scene.integrator) ||
           std::holds_alternative<BendingSpringsIntegrator>(scene.integrator);
}

// What the tuned scene could do without, by trying: a line each. False where it was interrupted.
bool tell_what_can_go(const Tuning& tuning, const Document& tuned, const Trial& best, bool limiter_needed) {
    if (!limiter_needed && has_springs(tuning.scene))
        std::fprintf(tuning.stream, "could go: strain_limiting, the springs alone meet the target\n");
    const auto* springs = std::get_if<ImplicitSpringsIntegrator>(&tuning.scene.integrator);
    if (springs != nullptr && springs->bend_stiffness > 0.0) {
        const std::optional<bool> holds = holds_without_bending(tuning, tuned);
        if (!holds) return false;
        if (*holds) {
            std::fprintf(tuning.stream,
                         "could go: bending (bend_stiffness 0), as far as the target is concerned; "
                         "folds will look different\n");
        }
    }
    if (!tuning.scene.colliders.empty()) {
        Document without = tuned;
        without.erase("colliders");
        const std::optional<Trial> trial = whole_run(tuning, without);
        if (!trial) return false;
        // Bit for bit the same motion: a single contact would show.
        if (trial->positions == best.positions)
            std::fprintf(tuning.stream, "could go: colliders, the cloth never touches them\n");
    }
    return true;
}

// A mesh file is named relative to its scene, which now lies elsewhere.
void move_mesh_file(Document& document, const std::filesystem::path& from, const std::filesystem::path& to) {
    if (!document["mesh"].contains("file")) return;
    const std::filesystem::path file = document["mesh"]["file"].get<std::string>();
    if (file.is_absolute()) return;
    const std::filesystem::path folder = std::filesystem::absolute(to).parent_path();
    const std::filesystem::path absolute = std::filesystem::absolute(from.parent_path() / file);
    document["mesh"]["file"] = absolute.lexically_proximate(folder).generic_string();
}

void write_scene(Document document, const TuneOptions& options) {
    if (!options.out) {
        std::fputs(scene_text(document).c_str(), stdout);
        return;
    }
    move_mesh_file(document, options.scene, *options.out);
    WholeFile output(*options.out);
    output.write(scene_text(document));
    output.commit();
}

// Of the scene's ceilings: what is stated is met as nearly as this while a cloth swings (docs/settings.md).
constexpr double ceiling_slack = 0.025;

// None where some triangle has no ceiling.
std::optional<double> stretch_that_the_scene_asks_for(const Scene& scene) {
    if (!scene.strain_limiting || !scene.strain_limiting->options.limits_stretch) return std::nullopt;
    const std::vector<float>& ceilings = scene.strain_limiting->stretch_ceilings;
    if (ceilings.empty()) return static_cast<double>(scene.strain_limiting->parameters.stretch_ceiling) + ceiling_slack;
    const auto [least, greatest] = std::ranges::minmax_element(ceilings);
    if (*least == 0.0f) return std::nullopt;
    return static_cast<double>(*greatest) + ceiling_slack;
}

Tuning set_up(const TuneOptions& options) {
    Tuning tuning;
    tuning.file = options.scene.string();
    tuning.document = read_scene_document(options.scene, options.overrides);
    tuning.scene = parse_scene(nlohmann::json(tuning.document), tuning.file);
    if (options.frames) tuning.scene.frames = *options.frames;
    tuning.goal.target = options.target;
    tuning.goal.target_stretch =
        options.target_stretch ? options.target_stretch : stretch_that_the_scene_asks_for(tuning.scene);
    if (options.budget_ms) tuning.goal.budget_seconds = 1e-3 * *options.budget_ms;
    tuning.device = choose_opencl_device(options.device);
    tuning.stream = options.out ? stdout : stderr;
    return tuning;
}

Document unlimited(const Tuning& tuning) {
    Document document = tuning.document;
    document.erase("strain_limiting");
    // Of steps of the limiter nothing is left but gravity.
    if (std::holds_alternative<StandAloneIntegrator>(tuning.scene.integrator)) document.erase("integrator");
    return document;
}

bool names_a_solver(const Document& document) {
    const auto limiting = document.find("strain_limiting");
    return limiting != document.end() && limiting->is_object() && limiting->contains("solver");
}

int interruption() {
    std::fprintf(stderr, "interrupted; no scene is written\n");
    return exit_code_of_interruption();
}

}  // namespace

int tune_command(const TuneOptions& options) {
    const Tuning tuning = set_up(options);
    if (options.out) check_not_an_input(*options.out, input_files(tuning.scene));
    if (options.out) check_file_place(*options.out);
    note_interruptions();
    Table table(tuning.stream);

    const std::optional<Trial> without_limiter = whole_run(tuning, unlimited(tuning));
    if (!without_limiter) return interruption();
    table.add_without_limiter(*without_limiter, tuning.goal);

    const LimiterSettings given = limiter_settings(tuning.scene);
    const TuningFreedom freedom{
        .regularization = !given.limiting.options.regularization_per_triangle,
        .solver = !names_a_solver(tuning.document),
        .ceiling = options.target_stretch.has_value() && !given.limiting.options.stretch_ceiling_per_triangle};
    const std::optional<Trial> best =
        search_settings(tuning.goal, given, freedom, tuning.scene.frames,
                        [&](const LimiterSettings& settings, int frames, const auto& enough) {
                            auto trial = run_trial(with_settings(tuning.document, given, settings), tuning.file, frames,
                                                   tuning.device, enough);
                            if (trial) table.add(*trial, tuning.goal);
                            return trial;
                        });
    if (!best) return interruption();
    const Document tuned = with_settings(tuning.document, given, best->settings);
    std::fprintf(tuning.stream, "best, over %d frames:\n", best->frames);
    table.add(*best, tuning.goal);
    if (!tell_what_can_go(tuning, tuned, *best, !tuning.goal.meets_target(*without_limiter))) return interruption();
    write_scene(tuned, options);
    if (tuning.goal.meets_target(*best) && tuning.goal.within_budget(*best)) return exit_done;
    const std::optional<double> stretch = tuning.goal.target_stretch;
    std::fprintf(stderr, "error: %s: no settings tried meet %.3g %% area change%s%s; the best are written\n",
                 tuning.file.c_str(), 100.0 * options.target,
                 stretch ? (" and a stretch of " + stretch_text(*stretch)).c_str() : "",
                 options.budget_ms ? " within the budget" : "");
    return exit_broke_down;
}

}  // namespace apsl::scenes
