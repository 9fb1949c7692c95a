// SPDX-License-Identifier: MIT
//
// The fields of Options and Parameters: names, ranges, units and a line of documentation, once. From these come the
// checks of validate(), the keys of scenes, Python's records, the printing of fuzzed cases, and by
// docs/write_fields.py the lists in the documents and the schema of scenes. A field that is missing here stops the
// compiler.
#pragma once

#include "../kernels/constants.h"

#include <apsl/options.hpp>
#include <apsl/parameters.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

namespace apsl {

/// What a number may be: from `least` to `greatest`, without an end that is excluded.
struct Bounds {
    double least = -std::numeric_limits<double>::infinity();
    double greatest = std::numeric_limits<double>::infinity();
    bool least_excluded = false;
    bool greatest_excluded = false;
    const char* zero = nullptr;  ///< what 0 means, where it is legal beside the rest

    /// Of a 32-bit number: 1.01f is at or above 1.01.
    constexpr bool hold(double value) const {
        if (zero && value == 0.0) return true;
        const double lower = static_cast<float>(least);
        return (least_excluded ? value > lower : value >= lower) &&
               (greatest_excluded ? value < greatest : value <= greatest);
    }
};

template <class Struct, class Value>
struct Field {
    const char* name;
    Value Struct::* member;
    Bounds bounds;  ///< of a number
    const char* unit;
    const char* text;  ///< documentation, a line
    bool in_scenes =
        true;  ///< a key of strain_limiting; otherwise a scene says it elsewhere, or leaves it to the device
    bool may_be_a_list = false;  ///< a scene may give one number for each triangle
};

/// Lower ceilings leave sub-steps nothing to work with.
inline constexpr double least_stretch_ceiling = 1.01;
static_assert(static_cast<float>(least_stretch_ceiling) == APSLK_LEAST_STRETCH_CEILING);

inline constexpr Bounds any_whole{.least = 0.0};
inline constexpr Bounds at_least_one{.least = 1.0};
/// A kernel holds as many anchors in registers.
inline constexpr std::uint32_t most_tethers = 4;
/// The host queues each of them.
inline constexpr Bounds sub_step_count{.least = 0.0, .greatest = 10000.0};
inline constexpr Bounds iteration_count{.least = 1.0, .greatest = 10000.0};

inline constexpr std::tuple parameter_fields{
    Field{"time_step", &Parameters::time_step, Bounds{.least = 0.0, .least_excluded = true}, "s", "Δt of Algorithm 1.",
          false},
    Field{"regularization", &Parameters::regularization, at_least_one, "",
          "α, multiplies the diagonal of G (Section 4). Not read where each triangle has its own.", true, true},
    Field{"sub_steps", &Parameters::sub_steps, sub_step_count, "", "Solves a call, at most."},
    Field{
        "most_sub_steps", &Parameters::most_sub_steps, sub_step_count, "",
        "With a stretch ceiling the device takes from sub_steps to this number of small steps, as stretch and tension "
        "ask for. 0: twice sub_steps where steps are small and α is the same in all, sub_steps elsewhere."},
    Field{"target_area_change", &Parameters::target_area_change, Bounds{.least = 0.0}, "",
          "No further sub-step once every |A − A⁰| / A⁰ is at or below it."},
    Field{"tolerance", &Parameters::tolerance, Bounds{.least = 0.0, .greatest = 1.0, .greatest_excluded = true}, "",
          "CG stops at this residual over the right-hand side; in small steps at three times it."},
    Field{"max_iterations", &Parameters::max_iterations, iteration_count, "", "CG iterations a solve, at most."},
    Field{
        "adaptive_threshold", &Parameters::adaptive_threshold, any_whole, "",
        "0: α stays as given. Otherwise a solve with more CG iterations than this doubles α − 1 for the next, and one "
        "with at most half of it lowers α again towards the given value."},
    Field{"first_regularization", &Parameters::first_regularization,
          Bounds{.least = 1.0, .least_excluded = true, .zero = "the same in every sub-step"}, "",
          "α of the first sub-step. From there to regularization, in the last, α − 1 changes by the same factor a "
          "sub-step. 0: α is the same in all."},
    Field{"stretch_ceiling", &Parameters::stretch_ceiling,
          Bounds{.least = least_stretch_ceiling, .zero = "areas alone"}, "",
          "No principal stretch above this multiple of the rest shape. 0: areas alone. With areas held, edges end "
          "between "
          "1/this and this. Not read where each triangle has its own.",
          true, true},
    Field{"acceleration", &Parameters::acceleration, Bounds{}, "m/s²",
          "With integrates: what vertices that are not pinned gain in each small step.", false},
    Field{"damping", &Parameters::damping, Bounds{.least = 0.0}, "1/s",
          "With integrates: velocities fall by exp(−damping · t).", false},
    Field{"bending", &Parameters::bending, Bounds{.least = 0.0}, "N·m",
          "With bends: the rigidity that hinges resist bending with.", false},
    Field{"bending_iterations", &Parameters::bending_iterations, Bounds{.least = 1.0, .greatest = 1000.0}, "",
          "With bends: evaluations of bending a small step. Hinges are softer than asked for where "
          "B h²/(ρ l⁴) exceeds 0.0125 times its square.",
          false},
    Field{"stepping", &Parameters::stepping, Bounds{}, "",
          "Which positions each sub-step linearises about. whole_step: the end of the step. small_steps: all but the "
          "last move on by an equal part of the step and correct there. automatic: small steps from 20 sub-steps up, "
          "from 2 with a stretch ceiling, integrates or keeps_contacts."},
    Field{"enabled", &Parameters::enabled, Bounds{}, "", "false: the cloth is left alone.", false},
};

inline constexpr std::tuple option_fields{
    Field{"matrix", &Options::matrix, Bounds{}, "",
          "What couples the pressures. consistent: shared vertices. printed: shared edges, Eq. (4) as printed."},
    Field{"apply", &Options::apply, Bounds{}, "", "How the device applies the matrix."},
    Field{"execution", &Options::execution, Bounds{}, "",
          "How the device divides a call. many_groups: a launch for each step of the filter. one_group: one work-group "
          "for all of it. automatic: one_group for small cloths."},
    Field{"work_group_size", &Options::work_group_size, any_whole, "",
          "Work-items a group, a power of two. 0: what suits the device.", false},
    Field{"regularization_per_triangle", &Options::regularization_per_triangle, Bounds{}, "",
          "Each triangle has its own α, given with every call.", false},
    Field{"warm_start_sub_steps", &Options::warm_start_sub_steps, Bounds{.least = 0.0, .greatest = 65536.0}, "",
          "The solves of the next call start from the pressures of this many sub-steps. 0: they start from zero."},
    Field{"solver", &Options::solver, Bounds{}, "",
          "chebyshev: a fixed polynomial with the reach of α in place of CG, one launch an iteration. It requires "
          "matrix consistent, apply matrix_free, one α for all triangles, warm_start_sub_steps 0 and "
          "adaptive_threshold 0. automatic: chebyshev with a stretch ceiling, conjugate_gradient otherwise."},
    Field{"bound_interval", &Options::bound_interval, at_least_one, "",
          "By chebyshev: sub-steps from one bound of the matrix to the next. 1 for garments; as many as there are "
          "sub-steps where triangles keep their shape."},
    Field{"limits_stretch", &Options::limits_stretch, Bounds{}, "",
          "Principal stretches are limited along with the areas, and rest shapes given with every call. It requires "
          "solver chebyshev and bound_interval 1.",
          false},
    Field{"stretch_ceiling_per_triangle", &Options::stretch_ceiling_per_triangle, Bounds{}, "",
          "Each triangle has its own stretch ceiling, given with every call.", false},
    Field{"integrates", &Options::integrates, Bounds{}, "",
          "A call is a whole time step: positions and velocities in and out, acceleration and damping in every small "
          "step. It requires velocities, many_groups, sub_steps ≥ 2 and small steps.",
          false},
    Field{
        "keeps_contacts", &Options::keeps_contacts, Bounds{}, "",
        "Vertices stay outside of what they touch: a plane for each is given with every call. It requires velocities, "
        "many_groups, sub_steps ≥ 2 and small steps.",
        false},
    Field{"bends", &Options::bends, Bounds{}, "",
          "Hinges resist bending, and their rest state is given with every call. It requires integrates and "
          "limits_stretch.",
          false},
    Field{"acceleration_per_vertex", &Options::acceleration_per_vertex, Bounds{}, "",
          "Each vertex has an acceleration beside the one of all, given with every call. It requires integrates.",
          false},
    Field{"tethers_per_vertex", &Options::tethers_per_vertex, Bounds{.least = 0.0, .greatest = most_tethers}, "",
          "Tethers of each vertex to pinned vertices, given with every call. It requires integrates.", false},
};

/// Of the caller's buffers.
inline constexpr std::tuple layout_fields{
    Field{"position_stride", &Options::position_stride, at_least_one, "floats", "From one position to the next."},
    Field{"velocity_stride", &Options::velocity_stride, at_least_one, "floats", "From one velocity to the next."},
    Field{"position_component_stride", &Options::position_component_stride, at_least_one, "floats",
          "From a position's x to its y, and from y to z."},
    Field{"velocity_component_stride", &Options::velocity_component_stride, at_least_one, "floats",
          "The same of velocities."},
    Field{"inverse_mass_stride", &Options::inverse_mass_stride, at_least_one, "floats",
          "From one inverse mass to the next."},
    Field{"positions_only", &Options::positions_only, Bounds{}, "",
          "There are no velocities: a call corrects the positions at the end of the step in place."},
};

/// An enumeration's values and their names.
template <class Enum>
inline constexpr std::array<std::pair<Enum, const char*>, 0> names_of{};
template <>
inline constexpr std::array names_of<Matrix>{std::pair{Matrix::consistent, "consistent"},
                                             std::pair{Matrix::printed, "printed"}};
template <>
inline constexpr std::array names_of<Apply>{std::pair{Apply::assembled_csr, "assembled_csr"},
                                            std::pair{Apply::matrix_free, "matrix_free"}};
template <>
inline constexpr std::array names_of<Execution>{std::pair{Execution::automatic, "automatic"},
                                                std::pair{Execution::many_groups, "many_groups"},
                                                std::pair{Execution::one_group, "one_group"}};
template <>
inline constexpr std::array names_of<Stepping>{std::pair{Stepping::automatic, "automatic"},
                                               std::pair{Stepping::whole_step, "whole_step"},
                                               std::pair{Stepping::small_steps, "small_steps"}};
template <>
inline constexpr std::array names_of<Solver>{std::pair{Solver::conjugate_gradient, "conjugate_gradient"},
                                             std::pair{Solver::chebyshev, "chebyshev"},
                                             std::pair{Solver::automatic, "automatic"}};

/// The name of an enumeration's value; empty where it has none.
template <class Enum>
constexpr std::string_view name_of(Enum value) {
    for (const auto& [known, name] : names_of<Enum>)
        if (known == value) return name;
    return {};
}

/// Whether a field holds several numbers.
template <class Value>
inline constexpr bool is_vector = false;
template <>
inline constexpr bool is_vector<std::array<float, 3>> = true;

/// `action(field)` of every field of a table.
template <class Action, class... Fields>
void for_each_field(const std::tuple<Fields...>& table, const Action& action) {
    std::apply([&](const auto&... field) { (action(field), ...); }, table);
}

struct AnyValue {
    template <class Value>
    operator Value() const;
};

/// Number of fields of a plain struct: how many values its braces take.
template <class Struct, class... Values>
consteval std::size_t field_count() {
    if constexpr (requires { Struct{Values{}..., AnyValue{}}; })
        return field_count<Struct, Values..., AnyValue>();
    else
        return sizeof...(Values);
}

static_assert(std::tuple_size_v<decltype(parameter_fields)> == field_count<Parameters>(),
              "a field of apsl::Parameters is missing in parameter_fields");
static_assert(std::tuple_size_v<decltype(option_fields)> + std::tuple_size_v<decltype(layout_fields)> ==
                  field_count<Options>(),
              "a field of apsl::Options is missing in option_fields or layout_fields");

}  // namespace apsl
