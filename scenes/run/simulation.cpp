// SPDX-License-Identifier: MIT
#include "run/simulation.hpp"

#include "pipeline/advance.hpp"
#include "pipeline/measures.hpp"
#include "run/scene_springs.hpp"
#include "run/stopwatch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace apsl::scenes {
namespace {

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

// Of one step.
void note(const AreaChange& change, FrameReport& report) {
    report.max_area_change = std::max(report.max_area_change, change.max);
    // Sum of squares until the frame is complete.
    report.rms_area_change += change.rms * change.rms;
}

void add_to_step(const Stopwatch& part, FrameReport& report) {
    report.step_seconds += part.seconds();
    report.processor_seconds += part.processor_seconds();
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
    if (stats.status != Status::off)
        report.energy_kept = std::min(report.energy_kept, static_cast<double>(stats.energy_kept));
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
    for (const MovingCollider& collider : colliders_)
        starts_inside_ = starts_inside_ || start_inside(cloth_, collider.shape).vertices > 0;
    make_springs(scene);
    name_stages(scene);
}

bool Simulation::is_inside(std::span<const ColliderStep> colliders) const {
    return std::any_of(colliders.begin(), colliders.end(),
                       [&](const ColliderStep& collider) { return start_inside(cloth_, collider.shape).vertices > 0; });
}

// s
double Simulation::start_of(int step) const {
    return (static_cast<double>(frame_) * steps_per_frame_ + step) * time_step_;
}

std::vector<ColliderStep> Simulation::collider_steps(int step) const {
    std::vector<ColliderStep> steps;
    for (const MovingCollider& collider : colliders_)
        steps.push_back(collider_step(collider, start_of(step), time_step_));
    return steps;
}

void Simulation::make_springs(const Scene& scene) {
    if (std::holds_alternative<NoIntegrator>(scene.integrator) ||
        std::holds_alternative<StandAloneIntegrator>(scene.integrator))
        return;
    SceneSprings made = make_scene_springs(scene, cloth_);
    warnings_ = std::move(made.warnings);
    springs_.emplace(cloth_, std::move(made.springs), made.damping);
}

void Simulation::name_stages(const Scene& scene) {
    if (moving_pins_) stages_.emplace_back("pin_motion");
    if (std::holds_alternative<ImplicitSpringsIntegrator>(scene.integrator)) stages_.emplace_back("implicit_springs");
    if (std::holds_alternative<BendingSpringsIntegrator>(scene.integrator)) stages_.emplace_back("bending_springs");
    if (const auto* custom = std::get_if<CustomFilter>(&filter_))
        stages_.push_back(custom->name);
    else if (const auto* custom_step = std::get_if<CustomStep>(&filter_))
        stages_.push_back(custom_step->name);
    else if (scene.strain_limiting)
        stages_.emplace_back(scene.strain_limiting->options.integrates ? "stand_alone" : "strain_limiting");
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
    note(change, report);
}

void Simulation::measure_stretches(FrameReport& report) {
    const EdgeStretch stretch = edge_stretch(cloth_);
    report.max_edge_stretch = std::max(report.max_edge_stretch, stretch.max);
    report.min_edge_stretch = std::min(report.min_edge_stretch, stretch.min);
    report.max_principal_stretch = std::max(report.max_principal_stretch, range_of(principal_stretches(cloth_)).max);
    if (stretch.max > over_stretch_ratio) over_stretch_.measure(cloth_, frame_);
}

void Simulation::move_pins(int step, FrameReport& report) {
    if (!moving_pins_) return;
    const Stopwatch moving;
    moving_pins_->set_velocities(cloth_, start_of(step), time_step_);
    if (auto* device = std::get_if<OpenClStep>(&filter_)) device->place_pins(cloth_);
    report.pin_seconds += moving.seconds();
    add_to_step(moving, report);
}

void Simulation::run_step(int step, FrameReport& report) {
    move_pins(step, report);
    const Stopwatch integrating;
    integrate();
    report.integrator_seconds += integrating.seconds();
    add_to_step(integrating, report);
    if (const auto vertex = first_not_finite(cloth_.velocities)) {
        return break_down(step, "integrator", "velocity of vertex " + std::to_string(*vertex) + " is not finite",
                          report);
    }

    const std::vector<ColliderStep> colliders = collider_steps(step);
    std::optional<Stats> stats;
    if (!std::holds_alternative<std::monostate>(filter_)) {
        const Stopwatch filtering;
        if (auto* opencl = std::get_if<OpenClFilter>(&filter_)) stats = opencl->filter(cloth_, colliders);
        if (auto* reference = std::get_if<ReferenceFilter>(&filter_)) stats = reference->filter(cloth_, colliders);
        if (auto* custom = std::get_if<CustomFilter>(&filter_)) stats = custom->filter(cloth_);
        report.filter_seconds += filtering.seconds();
        add_to_step(filtering, report);
        note_stats(*stats, frame_, step, report);
    }
    const Stopwatch measuring;
    measure_areas(report, std::holds_alternative<CustomFilter>(filter_) ? std::nullopt : stats);
    report.measuring_seconds += measuring.seconds();
    if (stats && stats->status == Status::diverged) {
        return break_down(step, "strain_limiting",
                          "the filter met or made a number that is not finite" + first_offender(*stats), report);
    }

    const Stopwatch after_filter;
    if (!colliders_.empty() && !keeps_contacts(filter_)) {
        respond_to_collisions(colliders);
        report.collision_seconds += after_filter.seconds();
    }
    advance_positions(cloth_, time_step_);
    add_to_step(after_filter, report);
    if (const auto vertex = first_not_finite(cloth_.positions))
        return break_down(step, "advance", "position of vertex " + std::to_string(*vertex) + " is not finite", report);
    const Stopwatch measuring_end;
    measure_stretches(report);
    report.measuring_seconds += measuring_end.seconds();
}

void Simulation::respond_to_collisions(std::span<const ColliderStep> colliders) {
    resolve_collisions(cloth_, colliders, time_step_, starts_inside_);
    if (starts_inside_) starts_inside_ = is_inside(colliders);
}

bool Simulation::takes_whole_steps() const {
    return std::holds_alternative<OpenClStep>(filter_) || std::holds_alternative<ReferenceStep>(filter_) ||
           std::holds_alternative<CustomStep>(filter_);
}

void Simulation::run_whole_step(int step, FrameReport& report) {
    move_pins(step, report);
    auto* device = std::get_if<OpenClStep>(&filter_);
    if (!colliders_.empty() && !std::holds_alternative<CustomStep>(filter_)) {
        const Stopwatch looking;
        const std::vector<ColliderStep> colliders = collider_steps(step);
        if (device != nullptr)
            device->find_contacts(colliders);
        else
            std::get<ReferenceStep>(filter_).find_contacts(cloth_, colliders);
        report.collision_seconds += looking.seconds();
        add_to_step(looking, report);
    }
    auto* custom = std::get_if<CustomStep>(&filter_);
    const Stopwatch stepping;
    const Stats stats = device != nullptr   ? device->step(cloth_)
                        : custom != nullptr ? custom->step(cloth_)
                                            : std::get<ReferenceStep>(filter_).step(cloth_);
    report.filter_seconds += stepping.seconds();
    add_to_step(stepping, report);
    note_stats(stats, frame_, step, report);
    const Stopwatch measuring;
    note(custom != nullptr ? summarize(cloth_, scenes::area_changes(cloth_))
                           : AreaChange{stats.max_area_change, stats.rms_area_change},
         report);
    report.measuring_seconds += measuring.seconds();
    if (stats.status == Status::diverged) {
        return break_down(step, custom != nullptr ? custom->name : "stand_alone",
                          "the step met or made a number that is not finite" + first_offender(stats), report);
    }
}

void Simulation::read_back(FrameReport& report) {
    auto* device = std::get_if<OpenClStep>(&filter_);
    if (device == nullptr) return;
    const Stopwatch reading;
    device->read_back(cloth_);
    report.read_back_seconds = reading.seconds();
    report.processor_seconds += reading.processor_seconds();
}

Energy Simulation::energy() const {
    return scenes::energy(cloth_, springs_ ? springs_->springs() : std::span<const Spring>(), gravity_);
}

FrameReport Simulation::run_frame() {
    FrameReport report;
    report.frame = frame_;
    int steps = 0;
    while (steps < steps_per_frame_ && !breakdown_)
        if (takes_whole_steps())
            run_whole_step(steps++, report);
        else
            run_step(steps++, report);
    report.rms_area_change = std::sqrt(report.rms_area_change / steps);
    if (takes_whole_steps()) read_back(report);
    const Stopwatch measuring;
    if (takes_whole_steps()) {
        measure_stretches(report);
        if (keep_area_changes_) area_changes_ = scenes::area_changes(cloth_);
    }
    if (moving_pins_) pinned_area_change_ = std::max(pinned_area_change_, scenes::pinned_area_change(cloth_));
    report.max_speed = greatest_speed(cloth_);
    report.energy = energy();
    report.measuring_seconds += measuring.seconds();
    ++frame_;
    return report;
}

}  // namespace apsl::scenes
