// SPDX-License-Identifier: MIT
#include "fields.hpp"
#include "finite.hpp"
#include "invalid.hpp"

#include <apsl/error.hpp>

#include <array>
#include <bit>
#include <charconv>
#include <string>
#include <type_traits>

namespace apsl {
namespace {

// The shortest text that is this very number again: 1.0099999 is not 1.01.
template <class Number>
std::string number(Number value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string described(const Bounds& bounds, const char* kind, const std::string& unit) {
    std::string text;
    if (bounds.zero) text = std::string("0 (") + bounds.zero + ") or ";
    text += kind;
    if (bounds.least > -std::numeric_limits<double>::infinity())
        text += (bounds.least_excluded ? " > " : " >= ") + number(bounds.least);
    if (bounds.greatest < std::numeric_limits<double>::infinity())
        text += (bounds.greatest_excluded ? " and < " : " and <= ") + number(bounds.greatest);
    return unit.empty() ? text : text + " (" + unit + ")";
}

template <class Enum>
std::string listed() {
    std::string text;
    std::size_t left = names_of<Enum>.size();
    for (const auto& [value, name] : names_of<Enum>) {
        text += name;
        text += " (" + std::to_string(static_cast<int>(value)) + ")";
        --left;
        text += left > 1 ? ", " : left == 1 ? " or " : "";
    }
    return text;
}

template <class Struct, class Value>
void check(const Struct& given, const Field<Struct, Value>& field) {
    const Value value = given.*field.member;
    const auto refuse = [&](auto shown, const std::string& expected) {
        invalid(std::string(field.name) + " is " + number(shown) + ", expected " + expected);
    };
    if constexpr (std::is_enum_v<Value>) {
        if (name_of(value).empty()) refuse(static_cast<int>(value), listed<Value>());
    } else if constexpr (is_vector<Value>) {
        for (const auto component : value)
            if (!is_finite(component)) refuse(component, described(field.bounds, "finite numbers", field.unit));
    } else if constexpr (std::is_floating_point_v<Value>) {
        if (!is_finite(value) || !field.bounds.hold(value))
            refuse(value, described(field.bounds, "a finite number", field.unit));
    } else if constexpr (!std::is_same_v<Value, bool>) {
        if (!field.bounds.hold(value)) refuse(value, described(field.bounds, "a whole number", field.unit));
    }
}

constexpr const char* without_a_ceiling = "areas and bending alone let a cloth flow in its plane";

// The first option that small steps alone can give; null where there is none.
const char* needs_small_steps(const Options& options) {
    if (options.integrates) return "integrates";
    return options.keeps_contacts ? "keeps_contacts" : nullptr;
}

}  // namespace

void validate(const Parameters& parameters) {
    for_each_field(parameter_fields, [&](const auto& field) { check(parameters, field); });
    if (parameters.first_regularization != 0.0f && !(parameters.regularization > 1.0f))
        invalid("regularization is " + number(parameters.regularization) +
                ", expected a number > 1 where first_regularization is given");
    if (parameters.most_sub_steps != 0 && parameters.most_sub_steps < parameters.sub_steps)
        invalid("most_sub_steps is " + std::to_string(parameters.most_sub_steps) +
                ", expected 0 (automatic) or a whole number >= sub_steps, which is " +
                std::to_string(parameters.sub_steps));
}

void validate(const Options& options) {
    for_each_field(option_fields, [&](const auto& field) { check(options, field); });
    if (options.work_group_size != 0 && !std::has_single_bit(options.work_group_size))
        invalid("work_group_size is " + std::to_string(options.work_group_size) + ", expected a power of two");
    const bool matrix_free = options.matrix == Matrix::consistent && options.apply == Apply::matrix_free;
    if (options.execution == Execution::one_group) {
        if (!matrix_free) invalid("execution is one_group, which needs the consistent matrix, matrix-free");
        if (resolved_solver(options) != Solver::conjugate_gradient)
            invalid("execution is one_group, which needs solver conjugate_gradient");
    }
    if (const char* on = needs_small_steps(options)) {
        const std::string which = std::string(on) + " is on, which needs ";
        if (options.execution == Execution::one_group) invalid(which + "execution many_groups");
        if (options.positions_only) invalid(which + "velocities: positions_only is on");
    }
    if (options.stretch_ceiling_per_triangle && !options.limits_stretch)
        invalid("stretch_ceiling_per_triangle is on, which needs limits_stretch");
    if (options.bends && !options.integrates) invalid("bends is on, which needs integrates");
    if (options.acceleration_per_vertex && !options.integrates)
        invalid("acceleration_per_vertex is on, which needs integrates");
    if (options.tethers_per_vertex > 0 && !options.integrates)
        invalid("tethers_per_vertex is " + std::to_string(options.tethers_per_vertex) + ", which needs integrates");
    if (options.bends && !options.limits_stretch)
        invalid(std::string("bends is on, which needs limits_stretch: ") + without_a_ceiling);
    if (options.limits_stretch) {
        if (resolved_solver(options) != Solver::chebyshev)
            invalid("a stretch ceiling (limits_stretch) needs solver chebyshev");
        if (options.bound_interval != 1)
            invalid("bound_interval is " + std::to_string(options.bound_interval) +
                    ", expected 1 with a stretch ceiling (limits_stretch)");
    }
    if (resolved_solver(options) == Solver::chebyshev) {
        const std::string solver = options.solver == Solver::automatic
                                       ? "a stretch ceiling (limits_stretch) is kept by solver chebyshev"
                                       : "solver is chebyshev";
        if (!matrix_free) invalid(solver + ", which needs the consistent matrix, matrix-free");
        if (options.warm_start_sub_steps > 0) invalid(solver + ", which takes no warm_start_sub_steps");
        if (options.regularization_per_triangle) invalid(solver + ", which needs one regularization for all triangles");
    }
}

void validate(const Options& options, const Parameters& parameters) {
    validate(options);
    validate(parameters);
    if (options.positions_only && parameters.stepping == Stepping::small_steps)
        invalid("stepping is small_steps, which needs velocities: positions_only is on");
    if (parameters.most_sub_steps > parameters.sub_steps) {
        const auto needs = [&](bool held, const char* what) {
            if (!held)
                invalid("most_sub_steps is " + std::to_string(parameters.most_sub_steps) +
                        ", more than sub_steps, which needs " + what);
        };
        needs(options.limits_stretch, "limits_stretch on");
        needs(!options.positions_only, "velocities: positions_only is on");
        needs(parameters.stepping != Stepping::whole_step, "small steps: stepping is whole_step");
        needs(parameters.sub_steps >= 2, "sub_steps >= 2");
        needs(parameters.first_regularization == 0.0f, "first_regularization 0");
    }
    if (const char* on = needs_small_steps(options)) {
        if (parameters.sub_steps < 2)
            invalid("sub_steps is " + std::to_string(parameters.sub_steps) + ", expected at least 2: " + on + " is on");
        if (parameters.stepping == Stepping::whole_step)
            invalid(std::string("stepping is whole_step, which does not go with ") + on);
    }
    if (!options.integrates && (parameters.acceleration != std::array<float, 3>{} || parameters.damping != 0.0f))
        invalid("acceleration or damping is given, but integrates is off");
    if (parameters.bending > 0.0f && !options.bends)
        invalid("bending is " + number(parameters.bending) + ", expected 0: bends is off");
    if (parameters.bending > 0.0f && parameters.stretch_ceiling == 0.0f && !options.stretch_ceiling_per_triangle)
        invalid("bending is " + number(parameters.bending) + " with a stretch_ceiling of 0: " + without_a_ceiling);
    if (parameters.stretch_ceiling > 0.0f && !options.limits_stretch)
        invalid("stretch_ceiling is " + number(parameters.stretch_ceiling) + ", expected 0: limits_stretch is off");
    if (resolved_solver(options) == Solver::chebyshev && parameters.adaptive_threshold > 0)
        invalid("adaptive_threshold is " + std::to_string(parameters.adaptive_threshold) +
                ", expected 0: the solver is chebyshev, which has no iterations to go by");
}

}  // namespace apsl
