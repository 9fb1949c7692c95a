// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/implicit_springs.hpp"
#include "pipeline/over_stretch.hpp"
#include "run/filter_stage.hpp"
#include "run/report.hpp"
#include "run/scene.hpp"
#include "run/scene_cloth.hpp"

#include <optional>
#include <string>
#include <vector>

namespace apsl::scenes {

/// The stages a scene names, run step by step: pin motion, integrator, strain limiting, collision response, and then
/// x ← x + Δt v; or pin motion and a whole step, where the cloth stays on the device and is read back and measured at
/// the end of a frame. A stage that is not named is not made.
class Simulation {
public:
    /// `keep_area_changes`: measure the area change of every triangle at the end of a frame, for files and pictures.
    Simulation(const Scene& scene, SceneCloth cloth, FilterStage filter, bool keep_area_changes);

    /// Runs the steps of the next frame. After a breakdown the frame's status is diverged, and there is no next one.
    FrameReport run_frame();

    const std::optional<Breakdown>& breakdown() const { return breakdown_; }
    const ClothState& cloth() const { return cloth_; }
    FilterStage& filter() { return filter_; }
    /// Of the last step, |A − A⁰| / A⁰ per triangle as in FrameReport, [T]; empty without keep_area_changes.
    const std::vector<double>& area_changes() const { return area_changes_; }
    /// Of the cloth as it is now.
    Energy energy() const;
    /// At the ends of all steps so far.
    const OverStretch& over_stretch() const { return over_stretch_; }
    /// In the order of a step, as the report lists them.
    const std::vector<std::string>& stages() const { return stages_; }
    /// Steps whose spring solve ended short of its tolerance.
    int unconverged_spring_solves() const { return unconverged_spring_solves_; }
    /// Of all frames so far: pins that move apart change the areas of triangles between them.
    double pinned_area_change() const { return pinned_area_change_; }
    /// What the set-up had to do that a user should know of; one line each.
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    void make_springs(const Scene& scene);
    void name_stages(const Scene& scene);
    void run_step(int step, FrameReport& report);
    bool takes_whole_steps() const;
    void run_whole_step(int step, FrameReport& report);
    void read_back(FrameReport& report);
    std::vector<ColliderStep> collider_steps(int step) const;
    void respond_to_collisions(std::span<const ColliderStep> colliders);
    double start_of(int step) const;
    void move_pins(int step, FrameReport& report);
    void integrate();
    bool is_inside(std::span<const ColliderStep> colliders) const;
    void measure_areas(FrameReport& report, const std::optional<Stats>& stats);
    void measure_stretches(FrameReport& report);
    void break_down(int step, const std::string& stage, const std::string& what, FrameReport& report);

    ClothState cloth_;
    std::array<double, 3> gravity_;
    double time_step_;
    int steps_per_frame_;
    std::vector<MovingCollider> colliders_;
    bool starts_inside_ = false;  // of a collider, and has not come out yet
    FilterStage filter_;
    std::optional<Pins> moving_pins_;
    std::optional<ImplicitSprings> springs_;
    bool keep_area_changes_;
    int frame_ = 0;
    int unconverged_spring_solves_ = 0;
    double pinned_area_change_ = 0.0;
    std::vector<double> area_changes_;
    OverStretch over_stretch_;
    std::optional<Breakdown> breakdown_;
    std::vector<std::string> stages_;
    std::vector<std::string> warnings_;
};

}  // namespace apsl::scenes
