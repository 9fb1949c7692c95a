// SPDX-License-Identifier: MIT
#include "run/report.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace apsl::scenes {
namespace {

double median(const std::vector<FrameReport>& frames, double FrameReport::* seconds) {
    std::vector<double> values;
    for (const FrameReport& frame : frames) values.push_back(frame.*seconds);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

// What the filter did beyond correcting, of a frame or a run.
template <class Report>
void add_filter_notes(const Report& report, nlohmann::ordered_json& json) {
    json["raised_vertices"] = report.raised_vertices;
    json["greatest_mass_ratio"] = report.greatest_mass_ratio;
    json["max_stretch_excess"] = report.max_stretch_excess;
    json["stretch_rows"] = report.stretch_rows;
    json["energy_kept"] = report.energy_kept;
    if (!report.worsened) return;
    json["worsened"] = {{"frame", report.worsened->frame},
                        {"step", report.worsened->step},
                        {"triangle", report.worsened->triangle},
                        {"area_change", report.worsened->area_change},
                        {"initial_area_change", report.worsened->initial_area_change}};
}

nlohmann::ordered_json to_json(const FrameReport& frame) {
    nlohmann::ordered_json json{{"frame", frame.frame},
                                {"max_area_change", frame.max_area_change},
                                {"rms_area_change", frame.rms_area_change},
                                {"max_edge_stretch", frame.max_edge_stretch},
                                {"min_edge_stretch", frame.min_edge_stretch},
                                {"max_principal_stretch", frame.max_principal_stretch},
                                {"max_speed", frame.max_speed},
                                {"energy", to_json(frame.energy)},
                                {"sub_steps", frame.sub_steps},
                                {"iterations", frame.iterations},
                                {"pin_seconds", frame.pin_seconds},
                                {"integrator_seconds", frame.integrator_seconds},
                                {"filter_seconds", frame.filter_seconds},
                                {"collision_seconds", frame.collision_seconds},
                                {"step_seconds", frame.step_seconds},
                                {"read_back_seconds", frame.read_back_seconds},
                                {"measuring_seconds", frame.measuring_seconds},
                                {"writing_seconds", frame.writing_seconds},
                                {"status", status_name(frame.status)}};
    add_filter_notes(frame, json);
    return json;
}

nlohmann::ordered_json to_json(const RunSummary& summary) {
    nlohmann::ordered_json json{{"max_area_change", summary.max_area_change},
                                {"mean_max_area_change", summary.mean_max_area_change},
                                {"rms_area_change", summary.rms_area_change},
                                {"max_edge_stretch", summary.max_edge_stretch},
                                {"min_edge_stretch", summary.min_edge_stretch},
                                {"max_principal_stretch", summary.max_principal_stretch},
                                {"solves", summary.solves},
                                {"iterations_per_solve", summary.iterations_per_solve},
                                {"pin_seconds_per_frame", summary.pin_seconds_per_frame},
                                {"integrator_seconds_per_frame", summary.integrator_seconds_per_frame},
                                {"filter_seconds_per_frame", summary.filter_seconds_per_frame},
                                {"collision_seconds_per_frame", summary.collision_seconds_per_frame},
                                {"step_seconds_per_frame", summary.step_seconds_per_frame},
                                {"read_back_seconds_per_frame", summary.read_back_seconds_per_frame},
                                {"measuring_seconds_per_frame", summary.measuring_seconds_per_frame},
                                {"writing_seconds_per_frame", summary.writing_seconds_per_frame},
                                {"status", status_name(summary.status)}};
    add_filter_notes(summary, json);
    return json;
}

nlohmann::ordered_json to_json(const OverStretchReport& report) {
    nlohmann::ordered_json triangles = nlohmann::ordered_json::array();
    for (const auto& [worst, why] : report.entries) {
        triangles.push_back({{"triangle", worst.triangle},
                             {"frame", worst.frame},
                             {"edge_stretch", worst.edge_stretch},
                             {"area_change", worst.area_change},
                             {"why", why}});
    }
    return {{"above", over_stretch_ratio}, {"count", report.count}, {"triangles", triangles}};
}

}  // namespace

OverStretchReport describe(const OverStretch& over_stretch, const ClothState& cloth, bool limits_stretch) {
    constexpr std::size_t most = 10;
    std::vector<OverStretchedTriangle> triangles = over_stretch.triangles();
    OverStretchReport report{.count = triangles.size(), .entries = {}};
    triangles.resize(std::min(triangles.size(), most));
    for (const OverStretchedTriangle& worst : triangles)
        report.entries.push_back({worst, over_stretch_cause(cloth, worst.triangle, limits_stretch)});
    return report;
}

RunSummary summarize(const std::vector<FrameReport>& frames) {
    RunSummary summary;
    if (frames.empty()) return summary;
    std::int64_t iterations = 0;
    double squares = 0.0;
    for (const FrameReport& frame : frames) {
        summary.max_area_change = std::max(summary.max_area_change, frame.max_area_change);
        summary.mean_max_area_change += frame.max_area_change / static_cast<double>(frames.size());
        squares += frame.rms_area_change * frame.rms_area_change;
        summary.max_edge_stretch = std::max(summary.max_edge_stretch, frame.max_edge_stretch);
        summary.min_edge_stretch = std::min(summary.min_edge_stretch, frame.min_edge_stretch);
        summary.max_principal_stretch = std::max(summary.max_principal_stretch, frame.max_principal_stretch);
        summary.solves += frame.sub_steps;
        iterations += frame.iterations;
        summary.status = std::max(summary.status, frame.status);
        summary.raised_vertices = std::max(summary.raised_vertices, frame.raised_vertices);
        summary.greatest_mass_ratio = std::max(summary.greatest_mass_ratio, frame.greatest_mass_ratio);
        summary.max_stretch_excess = std::max(summary.max_stretch_excess, frame.max_stretch_excess);
        summary.stretch_rows = std::max(summary.stretch_rows, frame.stretch_rows);
        summary.energy_kept = std::min(summary.energy_kept, frame.energy_kept);
        if (frame.energy_kept < 1.0) ++summary.slowed_frames;
        if (frame.worsened && (!summary.worsened || frame.worsened->area_change > summary.worsened->area_change))
            summary.worsened = frame.worsened;
    }
    summary.rms_area_change = std::sqrt(squares / static_cast<double>(frames.size()));
    if (summary.solves > 0)
        summary.iterations_per_solve = static_cast<double>(iterations) / static_cast<double>(summary.solves);
    summary.pin_seconds_per_frame = median(frames, &FrameReport::pin_seconds);
    summary.integrator_seconds_per_frame = median(frames, &FrameReport::integrator_seconds);
    summary.filter_seconds_per_frame = median(frames, &FrameReport::filter_seconds);
    summary.collision_seconds_per_frame = median(frames, &FrameReport::collision_seconds);
    summary.step_seconds_per_frame = median(frames, &FrameReport::step_seconds);
    summary.read_back_seconds_per_frame = median(frames, &FrameReport::read_back_seconds);
    summary.measuring_seconds_per_frame = median(frames, &FrameReport::measuring_seconds);
    summary.writing_seconds_per_frame = median(frames, &FrameReport::writing_seconds);
    return summary;
}

std::string status_name(Status status) {
    switch (status) {
        case Status::ok:
            return "ok";
        case Status::not_converged:
            return "not_converged";
        case Status::worsened:
            return "worsened";
        case Status::diverged:
            return "diverged";
        case Status::off:
            return "off";
    }
    return "diverged";
}

nlohmann::ordered_json to_json(const Energy& energy) {
    return {{"kinetic", energy.kinetic},
            {"gravity", energy.gravity},
            {"springs", energy.springs},
            {"total", energy.total()}};
}

nlohmann::ordered_json to_json(const RunReport& report) {
    nlohmann::ordered_json json{
        {"scene", report.scene},
        {"backend", report.backend},
        {"device", report.device},
        {"vertices", report.vertices},
        {"triangles", report.triangles},
        {"pieces", {{"count", report.pieces.count}, {"without_pin", report.pieces.without_pin}}},
        {"light_vertices",
         {{"count", report.light.count},
          {"lightest", report.light.lightest},
          {"share_of_median_mass", report.light.share_of_median}}},
        {"cap_triangles",
         {{"count", report.caps.count},
          {"flattest", report.caps.flattest},
          {"height_over_longest_edge", report.caps.height}}},
        {"needle_triangles",
         {{"count", report.needles.count},
          {"sharpest", report.needles.sharpest},
          {"shortest_over_longest_edge", report.needles.shortest_over_longest}}},
        {"stages", report.stages},
        {"device_bytes", report.device_bytes},
        {"start_energy", to_json(report.start_energy)}};
    json["frames"] = nlohmann::ordered_json::array();
    for (const FrameReport& frame : report.frames) json["frames"].push_back(to_json(frame));
    json["summary"] = to_json(summarize(report.frames));
    json["over_stretched"] = to_json(report.over_stretch);
    if (report.breakdown) {
        json["breakdown"] = {{"frame", report.breakdown->frame},
                             {"step", report.breakdown->step},
                             {"stage", report.breakdown->stage},
                             {"what", report.breakdown->what}};
    }
    json["warnings"] = report.warnings;
    json["kernels"] = nlohmann::ordered_json::array();
    for (const KernelReport& kernel : report.kernels)
        json["kernels"].push_back({{"name", kernel.name}, {"launches", kernel.launches}, {"seconds", kernel.seconds}});
    return json;
}

}  // namespace apsl::scenes
