// SPDX-License-Identifier: MIT
#include "compare/contenders.hpp"

#include "run/input_error.hpp"

#include <algorithm>

namespace apsl::compare {
namespace {

using scenes::InputError;

const std::string kSubSteps = "strain_limiting.sub_steps";
const std::string kFirstRegularization = "strain_limiting.first_regularization";
const std::string kRegularization = "strain_limiting.regularization";
const std::string kTolerance = "strain_limiting.tolerance";
const std::string kAdaptive = "strain_limiting.adaptive_iterations";

ContenderKnob sub_steps(std::vector<double> sweep) {
    return {.name = kSubSteps, .standard = {}, .least = 0.0, .sweep = std::move(sweep)};
}

ContenderKnob regularization(std::vector<double> sweep) {
    return {.name = kRegularization, .standard = {}, .least = 1.0, .sweep = std::move(sweep)};
}

std::vector<Contender> make_contenders() {
    const std::string han = "Han 2015";
    std::vector<Contender> table;
    table.push_back({.name = "none",
                     .title = "Springs alone",
                     .citation = "Baraff and Witkin 1998",
                     .kind = ContenderKind::none,
                     .knobs = {},
                     .settings = {}});
    table.push_back({.name = "springs",
                     .title = "Stiff springs",
                     .citation = "Baraff and Witkin 1998",
                     .kind = ContenderKind::springs,
                     .knobs = {{.name = "stretch_stiffness_factor",
                                .standard = 1.0,
                                .least = 0.0,
                                .sweep = {1, 3, 10, 30, 100, 300, 1000}}},
                     .settings = {}});
    table.push_back({.name = "apsl_defaults",
                     .title = "Area preserving, the library's defaults",
                     .citation = han,
                     .kind = ContenderKind::ours,
                     .knobs = {},
                     .settings = {{"strain_limiting", nlohmann::json::object()}}});
    table.push_back({.name = "apsl",
                     .title = "Area preserving",
                     .citation = han,
                     .kind = ContenderKind::ours,
                     .knobs = {sub_steps({2, 5, 10, 20, 40}),
                               regularization({1.2, 1.05, 1.02}),
                               {.name = kTolerance, .standard = {}, .least = 0.0, .sweep = {0.1, 0.01}}},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.stepping", "whole_step"},
                                  {"strain_limiting.adaptive_iterations", 0}}});
    table.push_back({.name = "apsl_printed",
                     .title = "Area preserving, matrix as printed",
                     .citation = han,
                     .kind = ContenderKind::ours,
                     .knobs = {sub_steps({2, 5, 10, 20, 40}), regularization({3, 2, 1.5})},
                     // One work-group has the consistent matrix alone.
                     .settings = {{"strain_limiting.matrix", "printed"},
                                  {"strain_limiting.execution", "automatic"},
                                  {"strain_limiting.stepping", "whole_step"},
                                  {"strain_limiting.adaptive_iterations", 0}}});
    table.push_back(
        {.name = "apsl_adaptive",
         .title = "Area preserving, adaptive regularization",
         .citation = han,
         .kind = ContenderKind::ours,
         .knobs = {sub_steps({5, 10, 20}),
                   {.name = kRegularization, .standard = 1.01, .least = 1.0, .sweep = {}},
                   {.name = kAdaptive, .standard = 8.0, .least = 1.0, .sweep = {4, 8, 16}}},
         .settings = {{"strain_limiting.matrix", "consistent"}, {"strain_limiting.stepping", "whole_step"}}});
    // α is hardly above 1 in the first sub-steps, which reach far, and the later ones repair what those
    // overshoot; every solve starts from its pressures of the step before.
    table.push_back(
        {.name = "apsl_rising",
         .title = "Area preserving, rising α, kept pressures",
         .citation = han,
         .kind = ContenderKind::ours,
         .knobs = {sub_steps({3, 5, 8, 12, 20}),
                   {.name = kFirstRegularization, .standard = 1.005, .least = 0.0, .sweep = {1.02, 1.005, 1.001}},
                   regularization({2, 1.2})},
         .settings = {{"strain_limiting.matrix", "consistent"},
                      {"strain_limiting.stepping", "whole_step"},
                      {"strain_limiting.adaptive_iterations", 0},
                      {"strain_limiting.kept_pressures", 20}}});
    table.push_back({.name = "apsl_small_steps",
                     .title = "Area preserving, small steps",
                     .citation = han,
                     .kind = ContenderKind::ours,
                     .knobs = {sub_steps({8, 12, 20, 30}),
                               {.name = kFirstRegularization, .standard = 0.0, .least = 0.0, .sweep = {}},
                               regularization({1.2, 1.05}),
                               {.name = kTolerance, .standard = 0.03, .least = 0.0, .sweep = {}}},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.stepping", "small_steps"},
                                  {"strain_limiting.adaptive_iterations", 0}}});
    table.push_back({.name = "apsl_chebyshev",
                     .title = "Area preserving, small steps by Chebyshev",
                     .citation = han,
                     .kind = ContenderKind::ours,
                     .knobs = {sub_steps({8, 10, 12, 20}),
                               {.name = kFirstRegularization, .standard = 1.1, .least = 0.0, .sweep = {}},
                               regularization({1.4, 1.3}),
                               {.name = "strain_limiting.bound_period", .standard = 1, .least = 1, .sweep = {1, 100}}},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.solver", "chebyshev"},
                                  {"strain_limiting.stepping", "small_steps"},
                                  {"strain_limiting.adaptive_iterations", 0}}});
    table.push_back(
        {.name = "apsl_direct",
         .title = "Area preserving, direct solves",
         .citation = han,
         .kind = ContenderKind::direct,
         .knobs = {sub_steps({1, 2, 5, 10}), regularization({1.2, 1.05, 1.01})},
         .settings = {{"strain_limiting.matrix", "consistent"}, {"strain_limiting.stepping", "whole_step"}}});
    table.push_back({.name = "apsl_several_steps",
                     .title = "Area preserving, several steps a frame",
                     .citation = han,
                     .kind = ContenderKind::ours,
                     .knobs = {{.name = "steps_per_frame", .standard = 4.0, .least = 1.0, .sweep = {2, 4, 8}},
                               sub_steps({1, 2, 5}),
                               regularization({1.2, 1.05})},
                     .settings = {{"strain_limiting.matrix", "consistent"},
                                  {"strain_limiting.stepping", "whole_step"},
                                  {"strain_limiting.adaptive_iterations", 0}}});
    for (const methods::MethodInfo& method : methods::all_methods()) {
        Contender rival{.name = method.name,
                        .title = method.title,
                        .citation = method.citation,
                        .kind = ContenderKind::rival,
                        .knobs = {},
                        .settings = {},
                        .rival = &method};
        for (const methods::KnobInfo& knob : method.knobs) {
            rival.knobs.push_back(
                {.name = knob.name, .standard = knob.standard, .least = knob.least, .sweep = knob.sweep});
        }
        table.push_back(std::move(rival));
    }
    return table;
}

const ContenderKnob* find_knob(const Contender& contender, const std::string& name) {
    static const ContenderKnob steps_per_frame{.name = "steps_per_frame", .standard = {}, .least = 1.0, .sweep = {}};
    const auto found = std::find_if(contender.knobs.begin(), contender.knobs.end(),
                                    [&](const ContenderKnob& knob) { return knob.name == name; });
    if (found != contender.knobs.end()) return &*found;
    return name == steps_per_frame.name ? &steps_per_frame : nullptr;
}

bool takes_scene_paths(const Contender& contender) {
    return contender.kind == ContenderKind::ours || contender.kind == ContenderKind::direct;
}

}  // namespace

std::span<const Contender> contenders() {
    static const std::vector<Contender> table = make_contenders();
    return table;
}

const Contender& find_contender(const std::string& name) {
    std::string names;
    for (const Contender& contender : contenders()) {
        if (contender.name == name) return contender;
        names += (names.empty() ? "" : ", ") + contender.name;
    }
    throw InputError("unknown method \"" + name + "\", expected one of " + names);
}

void check_knobs(const Contender& contender, const KnobValues& knobs) {
    for (const auto& [name, value] : knobs.items()) {
        const ContenderKnob* knob = find_knob(contender, name);
        if (knob == nullptr) {
            // What a scene takes there is checked when it is parsed.
            if (takes_scene_paths(contender) &&
                (name.starts_with("strain_limiting.") || name.starts_with("integrator."))) {
                continue;
            }
            std::string names;
            for (const ContenderKnob& known : contender.knobs) names += known.name + ", ";
            throw InputError(contender.name + ": unknown knob \"" + name + "\", expected one of " + names +
                             "steps_per_frame" +
                             (takes_scene_paths(contender) ? " or a path below strain_limiting or integrator" : ""));
        }
        if (!value.is_number() || !(value.get<double>() >= knob->least)) {
            throw InputError(contender.name + ": " + name + " is " + value.dump() + ", expected a number ≥ " +
                             nlohmann::json(knob->least).dump());
        }
    }
}

std::vector<KnobValues> combinations(const KnobValues& lists) {
    std::vector<KnobValues> all{KnobValues::object()};
    for (const auto& [name, given] : lists.items()) {
        const KnobValues values = given.is_array() ? given : KnobValues::array({given});
        std::vector<KnobValues> longer;
        for (const KnobValues& combination : all) {
            for (const auto& value : values) {
                longer.push_back(combination);
                longer.back()[name] = value;
            }
        }
        all = std::move(longer);
    }
    return all;
}

std::vector<KnobValues> standard_sweep(const Contender& contender) {
    KnobValues lists = KnobValues::object();
    for (const ContenderKnob& knob : contender.knobs) {
        if (!knob.sweep.empty()) lists[knob.name] = knob.sweep;
    }
    return combinations(lists);
}

}  // namespace apsl::compare
