// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/error.hpp>
#include <apsl/strain_limiter.hpp>

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

// What Python sees of Parameters, Options and Stats: the only place that names their fields. A field that is missing
// here stops the compiler.
namespace apsl::python {

template <class Struct, class Value>
struct Field {
    const char* name;
    Value Struct::* member;
};

inline constexpr std::tuple parameter_fields{
    Field{"time_step", &Parameters::time_step},
    Field{"regularization", &Parameters::regularization},
    Field{"sub_steps", &Parameters::sub_steps},
    Field{"target_area_change", &Parameters::target_area_change},
    Field{"tolerance", &Parameters::tolerance},
    Field{"max_iterations", &Parameters::max_iterations},
    Field{"adaptive_iterations", &Parameters::adaptive_iterations},
    Field{"first_regularization", &Parameters::first_regularization},
    Field{"stepping", &Parameters::stepping},
    Field{"enabled", &Parameters::enabled},
};

/// Without the layouts: numpy arrays come as three floats a vertex.
inline constexpr std::tuple option_fields{
    Field{"matrix", &Options::matrix},
    Field{"apply", &Options::apply},
    Field{"execution", &Options::execution},
    Field{"work_group_size", &Options::work_group_size},
    Field{"regularization_per_triangle", &Options::regularization_per_triangle},
    Field{"kept_pressures", &Options::kept_pressures},
    Field{"solver", &Options::solver},
    Field{"bound_period", &Options::bound_period},
};
inline constexpr std::size_t layout_fields = 6;

inline constexpr std::tuple stats_fields{
    Field{"sub_steps", &Stats::sub_steps},
    Field{"cg_iterations", &Stats::cg_iterations},
    Field{"residual", &Stats::residual},
    Field{"max_area_change", &Stats::max_area_change},
    Field{"rms_area_change", &Stats::rms_area_change},
    Field{"initial_max_area_change", &Stats::initial_max_area_change},
    Field{"initial_rms_area_change", &Stats::initial_rms_area_change},
    Field{"status", &Stats::status},
    Field{"offender", &Stats::offender},
    Field{"offender_index", &Stats::offender_index},
    Field{"raised_vertices", &Stats::raised_vertices},
    Field{"greatest_mass_ratio", &Stats::greatest_mass_ratio},
};

/// An enumeration's values and the strings that stand for them in Python.
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
inline constexpr std::array names_of<Status>{
    std::pair{Status::ok, "ok"}, std::pair{Status::not_converged, "not_converged"},
    std::pair{Status::worsened, "worsened"}, std::pair{Status::diverged, "diverged"}, std::pair{Status::off, "off"}};
template <>
inline constexpr std::array names_of<Offender>{std::pair{Offender::none, "none"}, std::pair{Offender::vertex, "vertex"},
                                               std::pair{Offender::triangle, "triangle"}};
template <>
inline constexpr std::array names_of<Stepping>{std::pair{Stepping::automatic, "automatic"},
                                               std::pair{Stepping::whole_step, "whole_step"},
                                               std::pair{Stepping::small_steps, "small_steps"}};
template <>
inline constexpr std::array names_of<Solver>{std::pair{Solver::conjugate_gradient, "conjugate_gradient"},
                                             std::pair{Solver::chebyshev, "chebyshev"}};
template <>
inline constexpr std::array names_of<ErrorCode>{
    std::pair{ErrorCode::invalid_argument, "invalid_argument"}, std::pair{ErrorCode::invalid_mesh, "invalid_mesh"},
    std::pair{ErrorCode::opencl, "opencl"}, std::pair{ErrorCode::kernel_build, "kernel_build"},
    std::pair{ErrorCode::unsupported, "unsupported"}};

struct AnyValue {
    template <class Value>
    operator Value() const;
};

/// Number of fields of a plain struct: how many values its braces take.
template <class Struct, class... Values>
consteval std::size_t field_count() {
    if constexpr (requires { Struct{Values{}..., AnyValue{}}; }) {
        return field_count<Struct, Values..., AnyValue>();
    } else {
        return sizeof...(Values);
    }
}

static_assert(std::tuple_size_v<decltype(parameter_fields)> == field_count<Parameters>(),
              "a field of apsl::Parameters is missing in parameter_fields");
static_assert(std::tuple_size_v<decltype(option_fields)> + layout_fields == field_count<Options>(),
              "a field of apsl::Options is missing in option_fields");
static_assert(std::tuple_size_v<decltype(stats_fields)> == field_count<Stats>(),
              "a field of apsl::Stats is missing in stats_fields");

}  // namespace apsl::python
