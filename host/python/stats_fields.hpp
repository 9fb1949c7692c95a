// SPDX-License-Identifier: MIT
#pragma once

#include "fields.hpp"

#include <apsl/error.hpp>
#include <apsl/strain_limiter.hpp>

#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

// What Python sees of Stats, and the names of its enumerations; Parameters and Options come from src/fields.hpp.
// Layouts are left out: numpy arrays come as three floats a vertex.
namespace apsl::python {

template <class Value>
struct StatsField {
    const char* name;
    Value Stats::* member;
};

inline constexpr std::tuple stats_fields{
    StatsField{"sub_steps", &Stats::sub_steps},
    StatsField{"iterations", &Stats::iterations},
    StatsField{"residual", &Stats::residual},
    StatsField{"max_area_change", &Stats::max_area_change},
    StatsField{"rms_area_change", &Stats::rms_area_change},
    StatsField{"initial_max_area_change", &Stats::initial_max_area_change},
    StatsField{"initial_rms_area_change", &Stats::initial_rms_area_change},
    StatsField{"status", &Stats::status},
    StatsField{"offender", &Stats::offender},
    StatsField{"offender_index", &Stats::offender_index},
    StatsField{"raised_vertices", &Stats::raised_vertices},
    StatsField{"greatest_mass_ratio", &Stats::greatest_mass_ratio},
    StatsField{"max_stretch", &Stats::max_stretch},
    StatsField{"max_stretch_excess", &Stats::max_stretch_excess},
    StatsField{"rms_stretch_excess", &Stats::rms_stretch_excess},
    StatsField{"initial_max_stretch_excess", &Stats::initial_max_stretch_excess},
    StatsField{"initial_rms_stretch_excess", &Stats::initial_rms_stretch_excess},
    StatsField{"stretch_rows", &Stats::stretch_rows},
    StatsField{"energy_kept", &Stats::energy_kept},
};

}  // namespace apsl::python

namespace apsl {

template <>
inline constexpr std::array names_of<Status>{
    std::pair{Status::ok, "ok"}, std::pair{Status::not_converged, "not_converged"},
    std::pair{Status::worsened, "worsened"}, std::pair{Status::diverged, "diverged"}, std::pair{Status::off, "off"}};
template <>
inline constexpr std::array names_of<Offender>{std::pair{Offender::none, "none"}, std::pair{Offender::vertex, "vertex"},
                                               std::pair{Offender::triangle, "triangle"}};
template <>
inline constexpr std::array names_of<ErrorCode>{
    std::pair{ErrorCode::invalid_argument, "invalid_argument"}, std::pair{ErrorCode::invalid_mesh, "invalid_mesh"},
    std::pair{ErrorCode::opencl, "opencl"}, std::pair{ErrorCode::kernel_build, "kernel_build"},
    std::pair{ErrorCode::unsupported, "unsupported"}};

}  // namespace apsl

namespace apsl::python {

static_assert(std::tuple_size_v<decltype(stats_fields)> == field_count<Stats>(),
              "a field of apsl::Stats is missing in stats_fields");

}  // namespace apsl::python
