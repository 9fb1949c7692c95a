// SPDX-License-Identifier: MIT
#include "run/commands.hpp"
#include "run/flat_cloth.hpp"
#include "run/folder_lock.hpp"
#include "run/frame_output.hpp"
#include "run/input_error.hpp"
#include "run/input_files.hpp"
#include "run/interruption.hpp"
#include "run/parse_scene.hpp"
#include "run/progress.hpp"
#include "run/simulation.hpp"
#include "run/stopwatch.hpp"
#include "run/summary.hpp"
#include "run/whole_file.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

namespace apsl::scenes {
namespace {

void warn(const std::string& line) {
    std::fprintf(stderr, "warning: %s\n", line.c_str());
}

void write_report(const std::filesystem::path& file, const nlohmann::ordered_json& report) {
    WholeFile output(file);
    // The name of a scene may be any bytes.
    output.write(report.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    output.write("\n");
    output.commit();
}

void add_settings_warning(const Scene& scene, std::vector<std::string>& warnings) {
    if (!scene.strain_limiting) return;
    const StrainLimiting& settings = *scene.strain_limiting;
    if (settings.options.integrates && !settings.options.limits_stretch) {
        warnings.push_back(scene.file +
                           ": integrator.stand_alone: areas alone do not hold a cloth together, which flows; give "
                           "strain_limiting a stretch_ceiling, 1.1 suits most");
    }
    const float least_regularization = settings.regularization.empty() ? settings.parameters.regularization
                                                                       : std::ranges::min(settings.regularization);
    if (settings.options.matrix == Matrix::printed && least_regularization < 2.0f) {
        warnings.push_back(
            scene.file +
            ": strain_limiting: sub-steps with the printed matrix diverge for a regularization below 2; use 2 or "
            "more, or the consistent matrix");
    }
}

// What only the run itself shows.
std::vector<std::string> late_warnings(const Simulation& simulation, const RunReport& report) {
    std::vector<std::string> warnings;
    if (std::string advice = convergence_advice(report); !advice.empty()) warnings.push_back(std::move(advice));
    if (std::string advice = ceiling_advice(report); !advice.empty()) warnings.push_back(std::move(advice));
    constexpr double much = 0.05;
    if (simulation.pinned_area_change() > much) {
        std::ostringstream text;
        text.precision(3);
        text << "triangles whose three corners are pinned change their areas by up to "
             << 100.0 * simulation.pinned_area_change()
             << " %, by the motion of their pins alone; no limiter can mend that, and the report counts it";
        warnings.push_back(text.str());
    }
    if (simulation.unconverged_spring_solves() > 0) {
        warnings.push_back("the springs' solve did not converge in " +
                           std::to_string(simulation.unconverged_spring_solves()) +
                           " steps; lower the time_step or the stiffness");
    }
    if (report.backend != "none")
        if (auto flat = flat_cloth_warning(simulation.cloth(), summarize(report.frames)))
            warnings.push_back(std::move(*flat));
    return warnings;
}

RunReport describe(const RunOptions& options, Simulation& simulation) {
    RunReport report;
    report.scene = options.scene.string();
    report.backend = "none";
    report.device = "none";
    if (const OpenClCloth* device = on_device(simulation.filter())) {
        report.backend = "opencl";
        report.device = device->device_name();
        report.device_bytes = device->device_bytes();
    } else if (!std::holds_alternative<std::monostate>(simulation.filter())) {
        report.backend = "reference";
        report.device = ReferenceFilter::device_name();
    }
    report.vertices = simulation.cloth().topology->vertex_count();
    report.triangles = simulation.cloth().topology->triangle_count();
    report.stages = simulation.stages();
    report.start_energy = simulation.energy();
    return report;
}

// Whether all frames were run: false after a breakdown or an interruption.
bool simulate(Simulation& simulation, int frames, std::optional<FrameOutput>& output, RunReport& report) {
    note_interruptions();
    Progress progress(frames);
    while (static_cast<int>(report.frames.size()) < frames && !interrupted()) {
        report.frames.push_back(simulation.run_frame());
        if (simulation.breakdown()) {
            report.breakdown = simulation.breakdown();
            return false;
        }
        if (output) {
            const Stopwatch writing;
            output->add_frame(simulation.cloth(), simulation.area_changes());
            report.frames.back().writing_seconds = writing.seconds();
        }
        progress.show(report.frames.back());
    }
    return static_cast<int>(report.frames.size()) == frames;
}

void add_kernel_times(OpenClCloth& device, RunReport& report) {
    for (KernelTime& kernel : device.kernel_times())
        report.kernels.push_back({std::move(kernel.name), kernel.launches, kernel.seconds});
}

}  // namespace

int run_command(const RunOptions& options) {
    Scene scene = read_scene(options.scene, options.overrides);
    if (options.frames) scene.frames = *options.frames;
    SceneCloth cloth = make_scene_cloth(scene);
    std::vector<std::string> warnings = cloth.warnings;
    const Pieces pieces = cloth.pieces;
    const LightVertices light = cloth.light;
    const CapTriangles caps = cloth.caps;
    const NeedleTriangles needles = cloth.needles;
    const std::vector<InputFile> inputs = input_files(scene);
    if (options.out) check_no_input_in(*options.out, inputs);
    if (options.report) check_not_an_input(*options.report, inputs);
    if (options.out && options.report) check_report_apart(*options.report, *options.out);
    std::optional<OpenClDevice> device;
    if (scene.strain_limiting && options.backend == Backend::opencl) device = choose_opencl_device(options.device);
    std::optional<FolderLock> lock;
    if (options.out) {
        make_writable_folder(*options.out);
        lock.emplace(*options.out);
    }
    if (options.report) check_file_place(*options.report);

    FilterStage filter = make_filter_stage(scene, cloth.state, options.backend, device, options.profile);
    Simulation simulation(scene, std::move(cloth), std::move(filter), options.out.has_value());
    warnings.insert(warnings.end(), simulation.warnings().begin(), simulation.warnings().end());
    add_settings_warning(scene, warnings);
    for (const std::string& line : warnings) warn(line);

    std::optional<FrameOutput> output;
    if (options.out) output.emplace(*options.out, simulation.cloth(), scene.time_step * scene.steps_per_frame);
    RunReport report = describe(options, simulation);
    report.pieces = pieces;
    report.light = light;
    report.caps = caps;
    report.needles = needles;
    report.stand_alone = scene.strain_limiting && scene.strain_limiting->options.integrates;
    report.limits_stretch = scene.strain_limiting && scene.strain_limiting->options.limits_stretch;
    const bool complete = simulate(simulation, scene.frames, output, report);
    if (!complete && !report.breakdown) {
        std::fprintf(stderr, "interrupted after %zu of %d frames; no report is written\n", report.frames.size(),
                     scene.frames);
        return exit_code_of_interruption();
    }
    if (OpenClCloth* on = on_device(simulation.filter()); on != nullptr && options.profile)
        add_kernel_times(*on, report);

    report.over_stretch = describe(simulation.over_stretch(), simulation.cloth(), report.limits_stretch);
    const std::vector<std::string> late = late_warnings(simulation, report);
    warnings.insert(warnings.end(), late.begin(), late.end());
    report.warnings = std::move(warnings);

    if (output) output->finish();
    const nlohmann::ordered_json document = to_json(report);
    if (options.out) write_report(*options.out / "report.json", document);
    if (options.report) write_report(*options.report, document);
    std::fputs(summary_text(report).c_str(), stdout);
    if (options.out) {
        std::printf("  frames                 %s: cloth.pvd for ParaView, cloth.obj and cloth.pc2 for Blender\n",
                    options.out->string().c_str());
        std::printf("  pictures               scenes/pictures/render.py %s\n", options.out->string().c_str());
    }
    for (const std::string& line : late) warn(line);
    if (report.breakdown) {
        std::fprintf(stderr,
                     "error: %s: broke down in frame %d, step %d, stage %s: %s; try a smaller time_step with more "
                     "steps_per_frame, %s or a larger regularization\n",
                     report.scene.c_str(), report.breakdown->frame, report.breakdown->step,
                     report.breakdown->stage.c_str(), report.breakdown->what.c_str(),
                     report.stand_alone ? "more sub_steps" : "softer springs");
        return exit_broke_down;
    }
    return exit_done;
}

}  // namespace apsl::scenes
