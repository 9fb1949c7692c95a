// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"
#include "run/scene.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace apsl::compare {

enum class ContenderKind {
    none,     ///< the scene's integrator alone
    springs,  ///< the same with stiffer stretch springs
    ours,     ///< apsl::StrainLimiter on an OpenCL device
    direct,   ///< ours on the processor, with a direct solver
    rival,    ///< of bench/methods
};

/// A knob of a contender. For ours the name is a path in the scene.
struct ContenderKnob {
    std::string name;
    std::optional<double> standard;  ///< where none is given; without one the scene's own value
    double least = 0.0;
    std::vector<double> sweep;  ///< of the standard sweep; empty: the standard alone
};

/// Whatever can be compared on a scene.
struct Contender {
    std::string name, title, citation;
    ContenderKind kind = ContenderKind::none;
    std::vector<ContenderKnob> knobs;
    std::vector<std::pair<std::string, nlohmann::json>> settings;  ///< scene paths that are always set so
    const methods::MethodInfo* rival = nullptr;                    ///< of ContenderKind::rival
};

/// Ours and all_methods(), in the order of a chart's legend.
std::span<const Contender> contenders();

/// Throws InputError naming those there are.
const Contender& find_contender(const std::string& name);

/// Values of a contender's knobs, by name. Numbers, but for what a scene has as text.
using KnobValues = nlohmann::ordered_json;

/// Throws InputError: a knob that the contender does not have, a number below its least, no number where one is needed.
/// `steps_per_frame` is a knob of all; ours take every path below strain_limiting and integrator.
void check_knobs(const Contender& contender, const KnobValues& knobs);

/// Every combination of the values of the contender's standard sweep.
std::vector<KnobValues> standard_sweep(const Contender& contender);

/// Every combination, an array standing for each of its entries: {"a": [1, 2], "b": 3}.
std::vector<KnobValues> combinations(const KnobValues& lists);

/// The scene that a contender runs, and all its knobs' values, those not given included. A frame takes as long as in
/// `document`, however many steps it has.
struct PreparedScene {
    nlohmann::json document;
    KnobValues knobs;
};
/// Throws InputError where the scene has no springs to make stiffer (ContenderKind::springs).
PreparedScene prepare_scene(const Contender& contender, const nlohmann::json& document, const std::string& file,
                            const KnobValues& knobs);

}  // namespace apsl::compare
