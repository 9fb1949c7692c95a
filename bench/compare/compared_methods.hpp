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

enum class MethodKind {
    none,         ///< the scene's integrator alone
    springs,      ///< the same with stiffer stretch springs
    ours,         ///< apsl::StrainLimiter on an OpenCL device
    direct,       ///< ours on the processor, with a direct solver
    baseline,     ///< of bench/methods
    tethers,      ///< methods::TetheredDistances in place of the scene's integrator
    small_steps,  ///< a baseline in small steps in its place
};

/// A parameter of a method. For ours the name is a path in the scene.
struct MethodParameter {
    std::string name;
    std::optional<double> standard;  ///< where none is given; without one the scene's own value
    double least = 0.0;
    std::vector<double> sweep;  ///< of the standard sweep; empty: the standard alone
};

/// Whatever can be compared on a scene.
struct ComparedMethod {
    std::string name, title, citation;
    MethodKind kind = MethodKind::none;
    std::vector<MethodParameter> parameters;
    std::vector<std::pair<std::string, nlohmann::json>> settings;  ///< scene paths that are always set so
    const methods::MethodInfo* baseline = nullptr;                 ///< of MethodKind::baseline and small_steps
};

/// Ours and all_methods(), in the order of a chart's legend.
std::span<const ComparedMethod> compared_methods();

/// Throws InputError naming those there are.
const ComparedMethod& find_method(const std::string& name);

/// Values of a method's parameters, by name. Numbers, but for what a scene has as text.
using ParameterValues = nlohmann::ordered_json;

/// Throws InputError: a parameter that the method does not have, a number below its least, no number where one is
/// needed. `steps_per_frame` is a parameter of all; ours take every path below strain_limiting and integrator.
void check_parameters(const ComparedMethod& method, const ParameterValues& parameters);

/// Every combination of the values of the method's standard sweep.
std::vector<ParameterValues> standard_sweep(const ComparedMethod& method);

/// Every combination, an array standing for each of its entries: {"a": [1, 2], "b": 3}.
std::vector<ParameterValues> combinations(const ParameterValues& lists);

/// The scene that a method runs, and all its parameters' values, those not given included. A frame takes as long as in
/// `document`, however many steps it has.
struct PreparedScene {
    nlohmann::json document;
    ParameterValues parameters;
};
/// Throws InputError where the scene has no springs to make stiffer (MethodKind::springs).
PreparedScene prepare_scene(const ComparedMethod& method, const nlohmann::json& document, const std::string& file,
                            const ParameterValues& parameters);

}  // namespace apsl::compare
