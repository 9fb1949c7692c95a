// SPDX-License-Identifier: MIT
#include "compare/compared_methods.hpp"

#include "methods/tethered_distances.hpp"
#include "run/input_error.hpp"

#include <apsl/parameters.hpp>

#include <algorithm>

namespace apsl::compare {
namespace {

using scenes::InputError;

const std::string han = "Han 2015";
const std::string sub_steps_path = "strain_limiting.sub_steps";
const std::string first_regularization_path = "strain_limiting.first_regularization";
const std::string regularization_path = "strain_limiting.regularization";
const std::string tolerance_path = "strain_limiting.tolerance";
const std::string stretch_ceiling_path = "strain_limiting.stretch_ceiling";
const std::string adaptive_path = "strain_limiting.adaptive_threshold";

MethodParameter sub_steps(std::vector<double> sweep) {
    return {.name = sub_steps_path, .standard = {}, .least = 0.0, .sweep = std::move(sweep)};
}

MethodParameter regularization(std::vector<double> sweep) {
    return {.name = regularization_path, .standard = {}, .least = 1.0, .sweep = std::move(sweep)};
}

// Distance constraints as a whole integrator.
// With no springs in front: the limiter takes the whole step.
ComparedMethod stand_alone(std::string name, std::string title, double tethers) {
    const Parameters defaults;
    return {
        .name = std::move(name),
        .title = std::move(title),
        .citation = han,
        .kind = MethodKind::ours,
        .parameters = {{.name = stretch_ceiling_path, .standard = 1.1, .least = 1.01, .sweep = {}},
                       {.name = sub_steps_path, .standard = defaults.sub_steps, .least = 2.0, .sweep = {20, 30, 60}},
                       {.name = regularization_path,
                        .standard = static_cast<double>(defaults.regularization),
                        .least = 1.0,
                        .sweep = {}}},
        .settings = {{"strain_limiting", nlohmann::json::object()},
                     {"integrator", {{"stand_alone", {{"tethers", tethers}}}}}}};
}

ComparedMethod distances(std::string name, std::string title, std::string citation, double tether_length) {
    const methods::TetherSettings standard;
    return {
        .name = std::move(name),
        .title = std::move(title),
        .citation = std::move(citation),
        .kind = MethodKind::tethers,
        .parameters = {{.name = "small_steps", .standard = standard.steps, .least = 1.0, .sweep = {5, 10, 20, 40, 80}},
                       {.name = "tether_length", .standard = tether_length, .least = 0.0, .sweep = {}},
                       {.name = "bending", .standard = standard.bending, .least = 0.0, .sweep = {}},
                       {.name = "damping", .standard = standard.damping, .least = 0.0, .sweep = {}}},
        .settings = {}};
}

MethodParameter parameter_of(const methods::ParameterInfo& parameter) {
    return {.name = parameter.name, .standard = parameter.standard, .least = parameter.least, .sweep = parameter.sweep};
}

// A baseline as a whole integrator: one sweep a small step, where the others have several.
ComparedMethod in_small_steps(std::string name, std::string title, const methods::MethodInfo& baseline) {
    const methods::TetherSettings standard;
    ComparedMethod method{
        .name = std::move(name),
        .title = std::move(title),
        .citation = baseline.citation,
        .kind = MethodKind::small_steps,
        .parameters = {{.name = "small_steps", .standard = standard.steps, .least = 1.0, .sweep = {20, 40, 80}},
                       {.name = "damping", .standard = standard.damping, .least = 0.0, .sweep = {}}},
        .settings = {},
        .baseline = &baseline};
    for (const methods::ParameterInfo& parameter : baseline.parameters) {
        method.parameters.push_back(parameter_of(parameter));
        if (parameter.name == "iterations") method.parameters.back().standard = 1.0;
        method.parameters.back().sweep.clear();
    }
    return method;
}

std::vector<ComparedMethod> make_compared_methods() {
    std::vector<ComparedMethod> table;
    table.push_back({.name = "none",
                     .title = "Springs alone",
                     .citation = "Baraff and Witkin 1998",
                     .kind = MethodKind::none,
                     .parameters = {},
                     .settings = {}});
    table.push_back({.name = "springs",
                     .title = "Stiff springs",
                     .citation = "Baraff and Witkin 1998",
                     .kind = MethodKind::springs,
                     .parameters = {{.name = "stretch_stiffness_factor",
                                     .standard = 1.0,
                                     .least = 0.0,
                                     .sweep = {1, 3, 10, 30, 100, 300, 1000}}},
                     .settings = {}});
    table.push_back({.name = "apsl_defaults",
                     .title = "Area preserving, the library's defaults",
                     .citation = han,
                     .kind = MethodKind::ours,
                     .parameters = {},
                     .settings = {{"strain_limiting", nlohmann::json::object()}}});
    table.push_back({.name = "apsl",
                     .title = "Area preserving",
                     .citation = han,
                     .kind = MethodKind::ours,
                     .parameters = {sub_steps({2, 5, 10, 20, 40}),
                                    regularization({1.2, 1.05, 1.02}),
                                    {.name = tolerance_path, .standard = {}, .least = 0.0, .sweep = {0.1, 0.01}}},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.stepping", "whole_step"},
                                  {"strain_limiting.adaptive_threshold", 0}}});
    table.push_back({.name = "apsl_printed",
                     .title = "Area preserving, matrix as printed",
                     .citation = han,
                     .kind = MethodKind::ours,
                     .parameters = {sub_steps({2, 5, 10, 20, 40}), regularization({3, 2, 1.5})},
                     // One work-group has the consistent matrix alone.
                     .settings = {{"strain_limiting.matrix", "printed"},
                                  {"strain_limiting.execution", "automatic"},
                                  {"strain_limiting.stepping", "whole_step"},
                                  {"strain_limiting.adaptive_threshold", 0}}});
    table.push_back(
        {.name = "apsl_adaptive",
         .title = "Area preserving, adaptive regularization",
         .citation = han,
         .kind = MethodKind::ours,
         .parameters = {sub_steps({5, 10, 20}),
                        {.name = regularization_path, .standard = 1.01, .least = 1.0, .sweep = {}},
                        {.name = adaptive_path, .standard = 8.0, .least = 1.0, .sweep = {4, 8, 16}}},
         .settings = {{"strain_limiting.matrix", "consistent"}, {"strain_limiting.stepping", "whole_step"}}});
    // α is hardly above 1 in the first sub-steps, which reach far, and the later ones repair what those
    // overshoot; every solve starts from its pressures of the step before.
    table.push_back(
        {.name = "apsl_rising",
         .title = "Area preserving, rising α, warm start",
         .citation = han,
         .kind = MethodKind::ours,
         .parameters =
             {sub_steps({3, 5, 8, 12, 20}),
              {.name = first_regularization_path, .standard = 1.005, .least = 0.0, .sweep = {1.02, 1.005, 1.001}},
              regularization({2, 1.2})},
         .settings = {{"strain_limiting.matrix", "consistent"},
                      {"strain_limiting.stepping", "whole_step"},
                      {"strain_limiting.adaptive_threshold", 0},
                      {"strain_limiting.warm_start_sub_steps", 20}}});
    table.push_back({.name = "apsl_small_steps",
                     .title = "Area preserving, small steps",
                     .citation = han,
                     .kind = MethodKind::ours,
                     .parameters = {sub_steps({8, 12, 20, 30}),
                                    {.name = first_regularization_path, .standard = 0.0, .least = 0.0, .sweep = {}},
                                    regularization({1.2, 1.05}),
                                    {.name = tolerance_path, .standard = 0.03, .least = 0.0, .sweep = {}}},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.stepping", "small_steps"},
                                  {"strain_limiting.adaptive_threshold", 0}}});
    table.push_back(
        {.name = "apsl_chebyshev",
         .title = "Area preserving, small steps by Chebyshev",
         .citation = han,
         .kind = MethodKind::ours,
         .parameters = {sub_steps({8, 10, 12, 20}),
                        {.name = first_regularization_path, .standard = 1.1, .least = 0.0, .sweep = {}},
                        regularization({1.4, 1.3}),
                        {.name = "strain_limiting.bound_interval", .standard = 1, .least = 1, .sweep = {1, 100}}},
         .settings = {{"strain_limiting.matrix", "consistent"},
                      {"strain_limiting.solver", "chebyshev"},
                      {"strain_limiting.stepping", "small_steps"},
                      {"strain_limiting.adaptive_threshold", 0}}});
    // The library's defaults beside the ceiling.
    table.push_back(
        {.name = "apsl_ceiling",
         .title = "Area preserving, stretch ceiling",
         .citation = han,
         .kind = MethodKind::ours,
         .parameters =
             {{.name = stretch_ceiling_path, .standard = 1.1, .least = 1.01, .sweep = {}},
              {.name = sub_steps_path, .standard = Parameters{}.sub_steps, .least = 2.0, .sweep = {20, 30, 60}}},
         .settings = {{"strain_limiting", nlohmann::json::object()}}});
    table.push_back(stand_alone("apsl_stand_alone", "Area preserving, stretch ceiling, stand-alone", 0.0));
    table.push_back(stand_alone("apsl_tethers", "Area preserving, stretch ceiling, tethers, stand-alone", 1.0));
    table.push_back(
        {.name = "apsl_direct",
         .title = "Area preserving, direct solves",
         .citation = han,
         .kind = MethodKind::direct,
         .parameters = {sub_steps({1, 2, 5, 10}), regularization({1.2, 1.05, 1.01})},
         .settings = {{"strain_limiting.matrix", "consistent"}, {"strain_limiting.stepping", "whole_step"}}});
    table.push_back({.name = "apsl_several_steps",
                     .title = "Area preserving, several steps a frame",
                     .citation = han,
                     .kind = MethodKind::ours,
                     .parameters = {{.name = "steps_per_frame", .standard = 4.0, .least = 1.0, .sweep = {2, 4, 8}},
                                    sub_steps({1, 2, 5}),
                                    regularization({1.2, 1.05})},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.stepping", "whole_step"},
                                  {"strain_limiting.adaptive_threshold", 0}}});
    table.push_back(distances("tethers", "Distances and tethers, small steps", "Kim et al. 2012", 1.0));
    table.push_back(distances("pbd_small_steps", "Distances without tethers, small steps", "Macklin et al. 2019", 0.0));
    for (const methods::MethodInfo& method : methods::all_methods()) {
        ComparedMethod baseline{.name = method.name,
                                .title = method.title,
                                .citation = method.citation,
                                .kind = MethodKind::baseline,
                                .parameters = {},
                                .settings = {},
                                .baseline = &method};
        for (const methods::ParameterInfo& parameter : method.parameters)
            baseline.parameters.push_back(parameter_of(parameter));
        table.push_back(std::move(baseline));
        if (method.name == "strain_based_dynamics_strain")
            table.push_back(
                in_small_steps("strain_based_dynamics_small_steps", "Strain based dynamics, small steps", method));
    }
    return table;
}

const MethodParameter* find_parameter(const ComparedMethod& method, const std::string& name) {
    static const MethodParameter steps_per_frame{.name = "steps_per_frame", .standard = {}, .least = 1.0, .sweep = {}};
    const auto found = std::find_if(method.parameters.begin(), method.parameters.end(),
                                    [&](const MethodParameter& parameter) { return parameter.name == name; });
    if (found != method.parameters.end()) return &*found;
    return name == steps_per_frame.name ? &steps_per_frame : nullptr;
}

bool takes_scene_paths(const ComparedMethod& method) {
    return method.kind == MethodKind::ours || method.kind == MethodKind::direct;
}

}  // namespace

std::span<const ComparedMethod> compared_methods() {
    static const std::vector<ComparedMethod> table = make_compared_methods();
    return table;
}

const ComparedMethod& find_method(const std::string& name) {
    std::string names;
    for (const ComparedMethod& method : compared_methods()) {
        if (method.name == name) return method;
        names += (names.empty() ? "" : ", ") + method.name;
    }
    throw InputError("unknown method \"" + name + "\", expected one of " + names);
}

void check_parameters(const ComparedMethod& method, const ParameterValues& parameters) {
    for (const auto& [name, value] : parameters.items()) {
        const MethodParameter* parameter = find_parameter(method, name);
        if (parameter == nullptr) {
            // What a scene takes there is checked when it is parsed.
            if (takes_scene_paths(method) && (name.starts_with("strain_limiting.") || name.starts_with("integrator.")))
                continue;
            std::string names;
            for (const MethodParameter& known : method.parameters) names += known.name + ", ";
            throw InputError(method.name + ": unknown parameter \"" + name + "\", expected one of " + names +
                             "steps_per_frame" +
                             (takes_scene_paths(method) ? " or a path below strain_limiting or integrator" : ""));
        }
        if (!value.is_number() || !(value.get<double>() >= parameter->least)) {
            throw InputError(method.name + ": " + name + " is " + value.dump() + ", expected a number ≥ " +
                             nlohmann::json(parameter->least).dump());
        }
    }
}

std::vector<ParameterValues> combinations(const ParameterValues& lists) {
    std::vector<ParameterValues> all{ParameterValues::object()};
    for (const auto& [name, given] : lists.items()) {
        const ParameterValues values = given.is_array() ? given : ParameterValues::array({given});
        std::vector<ParameterValues> longer;
        for (const ParameterValues& combination : all) {
            for (const auto& value : values) {
                longer.push_back(combination);
                longer.back()[name] = value;
            }
        }
        all = std::move(longer);
    }
    return all;
}

std::vector<ParameterValues> standard_sweep(const ComparedMethod& method) {
    ParameterValues lists = ParameterValues::object();
    for (const MethodParameter& parameter : method.parameters)
        if (!parameter.sweep.empty()) lists[parameter.name] = parameter.sweep;
    return combinations(lists);
}

}  // namespace apsl::compare
