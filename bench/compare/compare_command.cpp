// SPDX-License-Identifier: MIT
#include "compare/compare_command.hpp"

#include "compare/results_file.hpp"
#include "compare/study.hpp"
#include "run/commands.hpp"
#include "run/input_error.hpp"
#include "run/input_files.hpp"
#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace apsl::compare {
namespace {

using scenes::InputError;

// Command line and study together.
Study assemble_study(const CompareOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (options.frames) overrides.push_back("frames=" + std::to_string(*options.frames));
    Study study;
    if (options.study) study = read_study(*options.study, overrides);
    for (const auto& file : options.scenes) study.scenes.push_back(read_scene_case(file, overrides));
    if (study.scenes.empty()) throw InputError("compare: no scene, expected SCENE or a --study that names some");
    for (std::size_t k = 0; k < study.scenes.size(); ++k) {
        for (std::size_t other = 0; other < k; ++other) {
            if (study.scenes[k].name == study.scenes[other].name) {
                throw InputError("compare: two scenes are named " + study.scenes[k].name +
                                 ", expected different names");
            }
        }
    }
    if (study.methods.empty()) {
        study.methods = standard_methods(options.methods);
    } else if (!options.methods.empty()) {
        for (const std::string& name : options.methods) (void)find_method(name);
        std::erase_if(study.methods, [&](const MethodRuns& runs) {
            return std::find(options.methods.begin(), options.methods.end(), runs.method->name) ==
                   options.methods.end();
        });
    }
    if (options.measure_deviation || !options.deviation_frames.empty()) {
        if (!study.deviation) study.deviation.emplace();
        if (!options.deviation_frames.empty()) study.deviation->frames = options.deviation_frames;
    }
    if (options.run_seconds) study.run_seconds = options.run_seconds;
    if (options.rounds) study.rounds = *options.rounds;
    return study;
}

bool has_stretch_springs(const SceneCase& scene) {
    return scene.document.contains("integrator") && scene.document["integrator"].contains("implicit_springs");
}

void plan(const SceneCase& scene, const ComparedMethod& method, const ParameterValues& parameters,
          std::vector<PlannedRun>& runs) {
    PlannedRun run{&scene, &method, prepare_scene(method, scene.document, scene.file, parameters)};
    // Values of parameters that a scene does not take, such as a tolerance of 2, should be known before anything runs.
    (void)scenes::parse_scene(run.prepared.document, scene.file + ", " + method.name);
    const bool known = std::any_of(runs.begin(), runs.end(), [&](const PlannedRun& other) {
        return other.scene == &scene && other.method == &method &&
               nlohmann::json(other.prepared.parameters) == nlohmann::json(run.prepared.parameters);
    });
    if (!known) runs.push_back(std::move(run));
}

std::vector<PlannedRun> plan_runs(const Study& study) {
    std::vector<PlannedRun> runs;
    for (const SceneCase& scene : study.scenes) {
        for (const auto& [method, all_parameters] : study.methods) {
            if (method->kind == MethodKind::springs && !has_stretch_springs(scene)) {
                std::fprintf(stderr, "%s: springs left out, the scene has no stretch springs\n", scene.name.c_str());
                continue;
            }
            for (const ParameterValues& parameters : all_parameters) {
                if (method->kind == MethodKind::springs) {
                    // Their time is what they take longer than the soft ones.
                    ParameterValues steps = ParameterValues::object();
                    if (parameters.contains("steps_per_frame"))
                        steps["steps_per_frame"] = parameters["steps_per_frame"];
                    plan(scene, find_method("none"), steps, runs);
                }
                plan(scene, *method, parameters, runs);
            }
        }
    }
    return runs;
}

std::optional<DeviationPlan> deviation_plan(const Study& study, const SceneCase& scene) {
    if (!study.deviation) return std::nullopt;
    const int frames = scenes::parse_scene(scene.document, scene.file).frames;
    DeviationPlan plan{study.deviation->converged, study.deviation->frames};
    for (int k = 1; study.deviation->frames.empty() && k <= 10; ++k) {
        const int frame = std::max(static_cast<int>(std::int64_t{frames} * k / 10) - 1, 0);
        if (plan.frames.empty() || plan.frames.back() != frame) plan.frames.push_back(frame);
    }
    for (const int frame : plan.frames) {
        if (frame < 0 || frame >= frames) {
            throw InputError(scene.name + ": deviation at frame " + std::to_string(frame) +
                             ", expected one from 0 to " + std::to_string(frames - 1));
        }
    }
    return plan;
}

std::string described(const PlannedRun& run) {
    std::string text = run.scene->name + " " + run.method->name;
    for (const auto& [name, value] : run.prepared.parameters.items())
        text.append(" ").append(name.substr(name.rfind('.') + 1)).append("=").append(value.dump());
    return text;
}

void tell(std::size_t number, std::size_t count, const PlannedRun& run, const nlohmann::ordered_json& entry) {
    const double limiter = entry["limiter_seconds_per_frame"]["median"].get<double>();
    std::fprintf(stderr, "[%zu/%zu] %s: greatest area change %.3g %%, stretch %.4g, limiter %.3g ms a frame, %s\n",
                 number, count, described(run).c_str(), 100.0 * entry["max_area_change"].get<double>(),
                 entry["principal_stretch"]["max"].get<double>(), 1e3 * limiter,
                 entry["status"].get<std::string>().c_str());
}

std::filesystem::path converged_file(const std::filesystem::path& out, const SceneCase& scene) {
    std::filesystem::path file = out;
    return file.replace_extension("." + scene.name + ".converged.json");
}

// Throws InputError where the results or a converged solution would take the place of what the study reads.
void check_outputs(const Study& study, const CompareOptions& options) {
    std::vector<scenes::InputFile> inputs;
    if (options.study) inputs.push_back({"the study", *options.study});
    for (const SceneCase& scene : study.scenes)
        for (scenes::InputFile& input : scenes::input_files(scenes::parse_scene(scene.document, scene.file)))
            inputs.push_back(std::move(input));
    scenes::check_not_an_input(options.out, inputs);
    for (const SceneCase& scene : study.scenes) scenes::check_not_an_input(converged_file(options.out, scene), inputs);
}

// The converged solutions by scene, made when the first run needs one.
class Converged {
public:
    Converged(const CompareOptions& options) : out_(options.out) {}

    /// Null where the run was interrupted.
    const ConvergedSolution* of(const SceneCase& scene, const DeviationPlan& plan) {
        if (scene_ == &scene) return &*solution_;
        std::fprintf(stderr, "%s: converged solution\n", scene.name.c_str());
        solution_ = converged_solution(scene, plan.settings, plan.frames, converged_file(out_, scene));
        scene_ = solution_ ? &scene : nullptr;
        return solution_ ? &*solution_ : nullptr;
    }

private:
    std::filesystem::path out_;
    const SceneCase* scene_ = nullptr;
    std::optional<ConvergedSolution> solution_;
};

// The same run with profiling events, for the time on the device alone.
std::optional<double> device_seconds(const PlannedRun& run, RunConditions conditions) {
    conditions.profile = true;
    conditions.converged = nullptr;
    const std::optional<MeasuredRun> profiled = measure_run(run, conditions);
    if (!profiled || profiled->frames.empty()) return std::nullopt;
    return profiled->device_seconds / static_cast<double>(profiled->frames.size());
}

}  // namespace

int compare_command(const CompareOptions& options) {
    const Study study = assemble_study(options);
    check_outputs(study, options);
    const std::vector<PlannedRun> runs = plan_runs(study);
    RunConditions conditions{.device = {}, .converged = nullptr, .show = {}};
    if (std::any_of(runs.begin(), runs.end(),
                    [](const PlannedRun& run) { return run.method->kind == MethodKind::ours; })) {
        conditions.device = scenes::choose_opencl_device(options.device);
    }
    if (study.run_seconds) conditions.run_seconds = *study.run_seconds;
    conditions.keep_frames = study.keep_frames;
    ResultsFile results(options.out, conditions.device);
    for (const SceneCase& scene : study.scenes) {
        results.add_scene(scene);
        (void)deviation_plan(study, scene);
    }

    scenes::note_interruptions();
    Converged converged(options);
    const std::size_t count = runs.size() * static_cast<std::size_t>(study.rounds);
    std::size_t skipped = 0;
    for (std::size_t number = 1; number <= count; ++number) {
        const PlannedRun& run = runs[(number - 1) % runs.size()];
        conditions.round = 1 + static_cast<int>((number - 1) / runs.size());
        const std::optional<DeviationPlan> deviation = deviation_plan(study, *run.scene);
        conditions.profile = options.profile;
        if (results.has(run, conditions, deviation)) {
            ++skipped;
            continue;
        }
        conditions.profile = false;
        conditions.converged = deviation ? converged.of(*run.scene, *deviation) : nullptr;
        std::optional<MeasuredRun> measured;
        if (!scenes::interrupted()) {
            std::optional<scenes::Progress> progress;
            if (isatty(STDERR_FILENO) != 0)
                progress.emplace(scenes::parse_scene(run.scene->document, run.scene->file).frames);
            conditions.show = [&](const scenes::FrameReport& frame) {
                if (progress) progress->show(frame);
            };
            measured = measure_run(run, conditions);
        }
        std::optional<double> on_device;
        conditions.show = {};
        if (measured && options.profile && run.method->kind == MethodKind::ours)
            on_device = device_seconds(run, conditions);
        if (!measured || scenes::interrupted()) {
            std::fprintf(stderr, "interrupted before run %zu of %zu was done; the runs before it are in %s\n", number,
                         count, options.out.string().c_str());
            return scenes::exit_code_of_interruption();
        }
        tell(number, count, run, results.add(run, *measured, conditions, deviation, on_device));
        results.write();
    }
    results.write();
    std::printf("%s: %zu runs, %zu of them done before\n", options.out.string().c_str(), count, skipped);
    return scenes::exit_done;
}

}  // namespace apsl::compare
