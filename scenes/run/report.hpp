// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/energy.hpp"
#include "pipeline/over_stretch.hpp"
#include "run/cap_triangles.hpp"
#include "run/light_vertices.hpp"
#include "run/needle_triangles.hpp"
#include "run/pieces.hpp"

#include <apsl/stats.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsl::scenes {

/// A triangle whose area change the filter left greater than it was. Without it the result would have been better, and
/// the rest of the cloth keeps its correction.
struct WorsenedTriangle {
    int frame = 0;
    int step = 0;  ///< within the frame
    std::uint32_t triangle = 0;
    double area_change = 0.0;          ///< |A − A⁰| / A⁰ after the filter, the greatest of the cloth
    double initial_area_change = 0.0;  ///< the greatest of the cloth before
};

/// One frame: the greatest over its steps, sums for counts and seconds, the worst status. Area change is
/// |A − A⁰| / A⁰ at x + Δt v, after the filter and before collision response; edges are measured at the end of a step.
/// Of a stand-alone cloth area change is that of the steps' ends, and edges are measured at the end of the frame alone.
struct FrameReport {
    int frame = 0;
    double max_area_change = 0.0;
    double rms_area_change = 0.0;  ///< over triangles and the frame's steps
    double max_edge_stretch = 1.0;
    double min_edge_stretch = 1.0;
    double max_principal_stretch = 1.0;
    double max_speed = 0.0;  ///< m/s, of the free vertices at the end of the frame
    Energy energy;           ///< at the end of the frame
    std::int64_t sub_steps = 0;
    std::int64_t iterations = 0;
    double pin_seconds = 0.0;  ///< moving pins; of a stand-alone cloth with the transfer of their places to the device
    double integrator_seconds = 0.0;
    double filter_seconds = 0.0;  ///< with the transfers to and from the device; the calls of a stand-alone cloth
    double collision_seconds = 0.0;
    double step_seconds = 0.0;       ///< all of the steps, without what follows
    double read_back_seconds = 0.0;  ///< a stand-alone cloth from the device, to be measured and written
    double measuring_seconds = 0.0;
    double writing_seconds = 0.0;
    double processor_seconds = 0.0;  ///< of all threads, in the time of step_seconds and read_back_seconds
    Status status = Status::ok;
    std::uint32_t raised_vertices = 0;         ///< that weighed more than given, because the tension needs it
    double greatest_mass_ratio = 1.0;          ///< their greatest mass over the one given
    std::optional<WorsenedTriangle> worsened;  ///< the one that came to the greatest area change
    double max_stretch_excess = 0.0;           ///< over the stretch ceiling, after the filter
    std::uint32_t stretch_rows = 0;            ///< triangles that the ceiling held in the last sub-step
    double energy_kept = 1.0;                  ///< least share of kinetic energy that the bound on it left
};

/// Where a simulation broke down.
struct Breakdown {
    int frame = 0;
    int step = 0;  ///< within the frame
    std::string stage;
    std::string what;
};

/// Triangles with an edge that was longer than over_stretch_ratio times its rest length in the run.
struct OverStretchReport {
    struct Entry {
        OverStretchedTriangle worst;
        std::string why;
    };
    std::size_t count = 0;
    std::vector<Entry> entries;  ///< the ten with the longest edges, the longest first
};

OverStretchReport describe(const OverStretch& over_stretch, const ClothState& cloth, bool limits_stretch);

struct KernelReport {
    std::string name;
    std::int64_t launches = 0;
    double seconds = 0.0;  ///< on the device
};

struct RunReport {
    std::string scene;
    std::string backend;  ///< opencl, reference, or none where the scene has no strain limiting
    std::string device;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    Pieces pieces;
    LightVertices light;
    CapTriangles caps;
    NeedleTriangles needles;
    bool stand_alone = false;         ///< the limiter takes whole steps
    bool limits_stretch = false;      ///< then masses are raised as a matter of course
    std::vector<std::string> stages;  ///< what was there to run, in the order of a step
    std::size_t device_bytes = 0;
    Energy start_energy;  ///< before the first step
    std::vector<FrameReport> frames;
    OverStretchReport over_stretch;
    std::optional<Breakdown> breakdown;
    std::vector<std::string> warnings;
    std::vector<KernelReport> kernels;  ///< only of a profiled run
};

/// Over all frames: greatest values, medians of the seconds, the worst status.
struct RunSummary {
    double max_area_change = 0.0;
    double mean_max_area_change = 0.0;
    double rms_area_change = 0.0;  ///< over triangles and frames
    double max_edge_stretch = 1.0;
    double min_edge_stretch = 1.0;
    double max_principal_stretch = 1.0;
    std::int64_t solves = 0;
    double iterations_per_solve = 0.0;
    double pin_seconds_per_frame = 0.0;
    double integrator_seconds_per_frame = 0.0;
    double filter_seconds_per_frame = 0.0;
    double collision_seconds_per_frame = 0.0;
    double step_seconds_per_frame = 0.0;
    double read_back_seconds_per_frame = 0.0;
    double measuring_seconds_per_frame = 0.0;
    double writing_seconds_per_frame = 0.0;
    Status status = Status::ok;
    std::uint32_t raised_vertices = 0;
    double greatest_mass_ratio = 1.0;
    std::optional<WorsenedTriangle> worsened;
    double max_stretch_excess = 0.0;
    std::uint32_t stretch_rows = 0;
    double energy_kept = 1.0;
    int slowed_frames = 0;  ///< in which the bound on energy slowed something
};

RunSummary summarize(const std::vector<FrameReport>& frames);

/// "ok", "not_converged", "worsened" or "diverged".
std::string status_name(Status status);

/// kinetic, gravity, springs and total, J.
nlohmann::ordered_json to_json(const Energy& energy);

/// The report as README and docs describe it. Numbers that are not finite become null.
nlohmann::ordered_json to_json(const RunReport& report);

}  // namespace apsl::scenes
