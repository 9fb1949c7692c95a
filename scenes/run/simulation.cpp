// SPDX-License-Identifier: MIT
#include "run/simulation.hpp"

#include "pipeline/advance.hpp"
#include "pipeline/measures.hpp"
#include "run/scene_springs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace apsl::scenes {
namespace {

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Where it went wrong first, for the report.
std::optional<std::size_t> first_not_finite(const std::vector<double>& values) {
    const auto found = std::find_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
    if (found == values.end()) return std::nullopt;
    return static_cast<std::size_t>(found - values.begin()) / 3;
}

std::string first_offender(const Stats& stats) {
    if (stats.offender == Offender::none) return {};
    const char* what = stats.offender == Offender::vertex ? "vertex " : "triangle ";
    return ", first at " + (what + std::to_string(stats.offender_index));
}

// Of one call of the filter.
void note_stats(const Stats& stats, int frame, int step, FrameReport& report) {
    report.sub_steps += stats.sub_steps;
    report.iterations += stats.iterations;
    report.status = std::max(report.status, stats.status);
    report.raised_vertices = std::max(report.raised_vertices, stats.raised_vertices);
    report.greatest_mass_ratio = std::max(report.greatest_mass_ratio, static_cast<double>(stats.greatest_mass_ratio));
    report.max_stretch_excess = std::max(report.max_stretch_excess, static_cast<double>(stats.max_stretch_excess));
    report.stretch_rows = std::max(report.stretch_rows, stats.stretch_rows);
    if (stats.status != Status::worsened || stats.offender != Offender::triangle) return;
    if (report.worsened && report.worsened->area_change >= stats.max_area_change) return;
    report.worsened = {frame, step, stats.offender_index, stats.max_area_change, stats.initial_max_area_change};
}

}  // namespace

Simulation::Simulation(const Scene& scene, SceneCloth cloth, FilterStage filter, bool keep_area_changes)
    : cloth_(std::move(cloth.state)),
      gravity_(scene.gravity),
      time_step_(scene.time_step),
      steps_per_frame_(scene.steps_per_frame),
      colliders_(scene.colliders),
      filter_(std::move(filter)),
      keep_area_changes_(keep_area_changes) {
    Pins pins(cloth_, std::move(cloth.pins));
    if (pins.moving()) moving_pins_ = std::move(pins);
    starts_inside_ = is_inside();
    make_springs(scene);
    name_stages(scene);
}

bool Simulation::is_inside() const {
    return std::any_of(colliders_.begin(), colliders_.end(),
                       [&](const Collider& collider) { return start_inside(cloth_, collider).vertices > 0; });
}

void Simulation::make_springs(const Scene& scene) {
    if (std::holds_alternative<NoIntegrator>(scene.integrator)) return;
    SceneSprings made = make_scene_springs(scene, cloth_);
    warnings_ = std::move(made.warnings);
    springs_.emplace(cloth_, std::move(made.springs), made.damping);
}

void Simulation::name_stages(const Scene& scene) {
    if (moving_pins_) stages_.emplace_back("pin_motion");
    if (std::holds_alternative<ImplicitSpringsIntegrator>(scene.integrator)) stages_.emplace_back("implicit_springs");
    if (std::holds_alternative<StandAloneIntegrator>(scene.integrator)) stages_.emplace_back("stand_alone");
    if (const auto* custom = std::get_if<CustomFilter>(&filter_))
        stages_.push_back(custom->name);
    else if (scene.strain_limiting)
        stages_.emplace_back("strain_limiting");
    if (!scene.colliders.empty()) stages_.emplace_back("colliders");
}

void Simulation::integrate() {
    if (springs_) {
        if (!springs_->advance_velocities(cloth_, gravity_, time_step_).converged) ++unconverged_spring_solves_;
        return;
    }
    for (std::size_t v = 0; v < cloth_.inverse_masses.size(); ++v) {
        if (cloth_.inverse_masses[v] == 0.0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) cloth_.velocities[3 * v + axis] += time_step_ * gravity_[axis];
    }
}

void Simulation::break_down(int step, const std::string& stage, const std::string& what, FrameReport& report) {
    breakdown_ = Breakdown{frame_, step, stage, what};
    report.status = Status::diverged;
}

void Simulation::measure_areas(FrameReport& report, const std::optional<Stats>& stats) {
    AreaChange change;
    if (!stats || keep_area_changes_) {
        area_changes_ = predicted_area_changes(cloth_, time_step_);
        if (!stats) change = summarize(cloth_, area_changes_);
    }
    if (stats) change = {stats->max_area_change, stats->rms_area_change};
    report.max_area_change = std::max(report.max_area_change, change.max);
    // Sum of squares until the frame is complete.
    report.rms_area_change += change.rms * change.rms;
}

void Simulation::run_step(int step, FrameReport& report) {
    const Stopwatch before_filter;
    if (moving_pins_) {
        const double time = (static_cast<double>(frame_) * steps_per_frame_ + step) * time_step_;
        moving_pins_->set_velocities(cloth_, time, time_step_);
    }
    const Stopwatch integrating;
    integrate();
    report.integrator_seconds += integrating.seconds();
    report.step_seconds += before_filter.seconds();
    if (const auto vertex = first_not_finite(cloth_.velocities)) {
        return break_down(step, "integrator", "velocity of vertex " + std::to_string(*vertex) + " is not finite",
                          report);
    }

    std::optional<Stats> stats;
    if (!std::holds_alternative<std::monostate>(filter_)) {
        const Stopwatch filtering;
        if (auto* opencl = std::get_if<OpenClFilter>(&filter_)) stats = opencl->filter(cloth_);
        if (auto* reference = std::get_if<ReferenceFilter>(&filter_)) stats = reference->filter(cloth_);
        if (auto* custom = std::get_if<CustomFilter>(&filter_)) stats = custom->filter(cloth_);
        const double seconds = filtering.seconds();
        report.filter_seconds += seconds;
        report.step_seconds += seconds;
        note_stats(*stats, frame_, step, report);
    }
    measure_areas(report, std::holds_alternative<CustomFilter>(filter_) ? std::nullopt : stats);
    if (stats && stats->status == Status::diverged) {
        return break_down(step, "strain_limiting",
                          "the filter met or made a number that is not finite" + first_offender(*stats), report);
    }

    const Stopwatch after_filter;
    if (!colliders_.empty()) {
        resolve_collisions(cloth_, colliders_, time_step_, starts_inside_);
        if (starts_inside_) starts_inside_ = is_inside();
        report.collision_seconds += after_filter.seconds();
    }
    advance_positions(cloth_, time_step_);
    report.step_seconds += after_filter.seconds();
    if (const auto vertex = first_not_finite(cloth_.positions))
        return break_down(step, "advance", "position of vertex " + std::to_string(*vertex) + " is not finite", report);
    const EdgeStretch stretch = edge_stretch(cloth_);
    report.max_edge_stretch = std::max(report.max_edge_stretch, stretch.max);
    report.min_edge_stretch = std::min(report.min_edge_stretch, stretch.min);
    report.max_principal_stretch = std::max(report.max_principal_stretch, range_of(principal_stretches(cloth_)).max);
    if (stretch.max > over_stretch_ratio) over_stretch_.measure(cloth_, frame_);
}

Energy Simulation::energy() const {
    return scenes::energy(cloth_, springs_ ? springs_->springs() : std::span<const Spring>(), gravity_);
}

FrameReport Simulation::run_frame() {
    FrameReport report;
    report.frame = frame_;
    int steps = 0;
    while (steps < steps_per_frame_ && !breakdown_) run_step(steps++, report);
    report.rms_area_change = std::sqrt(report.rms_area_change / steps);
    report.max_speed = greatest_speed(cloth_);
    report.energy = energy();
    ++frame_;
    return report;
}

}  // namespace apsl::scenes
