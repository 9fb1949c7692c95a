// SPDX-License-Identifier: MIT
#include "run/summary.hpp"

#include <algorithm>
#include <cstdio>

namespace apsl::scenes {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
    const int size = std::snprintf(nullptr, 0, pattern, values...);
    std::string text(static_cast<std::size_t>(size) + 1, '\0');
    std::snprintf(text.data(), text.size(), pattern, values...);
    text.pop_back();
    return text;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "gravity alone" : text;
}

// Of a cap no mass is too small.
std::string raised_masses_advice(const RunReport& report) {
    const bool caps_alone = report.light.count == 0 && report.caps.count > 0;
    return caps_alone ? cap_triangles_advice(report.caps) : light_vertices_advice(report.light);
}

std::string times_text(const RunReport& report, const RunSummary& summary) {
    std::string text = format("  time a frame           %.2f ms in all", 1e3 * summary.step_seconds_per_frame);
    const char* before = "; ";
    const auto add = [&](const char* what, double seconds) {
        text += before + format("%s %.2f ms", what, 1e3 * seconds);
        before = ", ";
    };
    if (summary.pin_seconds_per_frame > 0.0) add("pins", summary.pin_seconds_per_frame);
    if (!report.stand_alone) add("integration", summary.integrator_seconds_per_frame);
    if (report.backend != "none")
        add(report.stand_alone ? "whole step" : "strain limiting", summary.filter_seconds_per_frame);
    if (summary.collision_seconds_per_frame > 0.0) add("collisions", summary.collision_seconds_per_frame);
    text += " (medians)\n  beside it              ";
    before = "";
    if (summary.read_back_seconds_per_frame > 0.0) add("reading back", summary.read_back_seconds_per_frame);
    add("measuring", summary.measuring_seconds_per_frame);
    if (summary.writing_seconds_per_frame > 0.0) add("writing", summary.writing_seconds_per_frame);
    return text + "\n";
}

}  // namespace

std::string summary_text(const RunReport& report) {
    const RunSummary summary = summarize(report.frames);
    const bool filtered = report.backend != "none";
    std::string text = format("%s: %zu vertices, %zu triangles, %zu frames\n", report.scene.c_str(), report.vertices,
                              report.triangles, report.frames.size());
    if (report.pieces.count > 1)
        text += format("  pieces                 %zu, %zu of them without a pin\n", report.pieces.count,
                       report.pieces.without_pin);
    text += "  stages                 " + joined(report.stages) + "\n";
    if (filtered) {
        text += "  strain limiting on     " + report.backend + ": " + report.device;
        if (report.device_bytes > 0) text += format(", %.1f MB", 1e-6 * static_cast<double>(report.device_bytes));
        text += "\n";
    }
    text += format("  greatest area change   %.2f %%, on average over frames %.2f %%\n",
                   100.0 * summary.max_area_change, 100.0 * summary.mean_max_area_change);
    text += format("  RMS area change        %.3f %%\n", 100.0 * summary.rms_area_change);
    text += format("  edges                  %.2f to %.2f of their rest length\n", summary.min_edge_stretch,
                   summary.max_edge_stretch);
    text += format("  principal stretch      %.3f at most\n", summary.max_principal_stretch);
    if (report.limits_stretch) {
        text += format("  stretch ceiling        exceeded by %.3f at most%s; it held up to %u of %zu triangles\n",
                       summary.max_stretch_excess,
                       summary.collision_seconds_per_frame > 0.0 && !report.stand_alone ? ", before collisions" : "",
                       summary.stretch_rows, report.triangles);
    }
    if (summary.slowed_frames > 0) {
        text += format(
            "  slowed                 in %d of %zu frames, down to %.2g of the kinetic energy: the cloth would "
            "have gained energy from nothing\n",
            summary.slowed_frames, report.frames.size(), summary.energy_kept);
    }
    if (report.over_stretch.count > 0) {
        const auto& [worst, why] = report.over_stretch.entries.front();
        text += format(
            "  over-stretched         %zu triangles with an edge beyond %.1f times; triangle %u at %.2f times, "
            "area off by %.2f %%, %s\n",
            report.over_stretch.count, over_stretch_ratio, worst.triangle, worst.edge_stretch,
            100.0 * worst.area_change, why.c_str());
    }
    if (summary.raised_vertices > 0 && !report.limits_stretch) {
        text += format(
            "  light vertices         %u of %zu too light for the tension at their triangles (lightest: %s); the "
            "filter "
            "raised their mass up to %.3g times: %s\n",
            summary.raised_vertices, report.vertices, lightest_text(report.light).c_str(), summary.greatest_mass_ratio,
            raised_masses_advice(report).c_str());
    }
    if (summary.worsened) {
        text += format(
            "  worsened               triangle %u in frame %d: area off by %.2f %%, where the greatest was %.2f %% "
            "before "
            "the filter; the rest of the cloth keeps its correction\n",
            summary.worsened->triangle, summary.worsened->frame, 100.0 * summary.worsened->area_change,
            100.0 * summary.worsened->initial_area_change);
    }
    if (filtered) {
        text += format("  iterations             %.1f a solve, %lld solves\n", summary.iterations_per_solve,
                       static_cast<long long>(summary.solves));
    }
    text += times_text(report, summary);
    text += "  status                 " + status_name(summary.status) + "\n";
    for (const KernelReport& kernel : report.kernels) {
        text += format("  %-30s %8lld launches %10.3f ms\n", kernel.name.c_str(),
                       static_cast<long long>(kernel.launches), 1e3 * kernel.seconds);
    }
    return text;
}

std::string convergence_advice(const RunReport& report) {
    const auto count = std::count_if(report.frames.begin(), report.frames.end(),
                                     [](const FrameReport& frame) { return frame.status == Status::not_converged; });
    if (count == 0) return {};
    return "strain limiting did not converge in " + std::to_string(count) + " of " +
           std::to_string(report.frames.size()) +
           " frames; raise strain_limiting.max_iterations or strain_limiting.regularization";
}

std::string ceiling_advice(const RunReport& report) {
    if (!report.limits_stretch) return {};
    constexpr double much = 0.1;
    const auto count = std::count_if(report.frames.begin(), report.frames.end(),
                                     [](const FrameReport& frame) { return frame.max_stretch_excess > much; });
    if (count == 0) return {};
    return format("the stretch ceiling was exceeded by up to %.3f, in %td of %zu frames by more than %.1f; raise ",
                  summarize(report.frames).max_stretch_excess, count, report.frames.size(), much) +
           "strain_limiting.sub_steps (30 suit most cloths, and most_sub_steps for impacts), take more time steps, or "
           "see that the pins "
           "leave "
           "the cloth room below its ceiling";
}

}  // namespace apsl::scenes
