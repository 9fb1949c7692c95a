// SPDX-License-Identifier: MIT
#include "methods/all_methods.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace apsl::methods {
namespace {

[[noreturn]] void refuse(const std::ostringstream& message) {
    throw Error(ErrorCode::invalid_argument, message.str());
}

template <class Entries>
std::string names_of(const Entries& entries) {
    std::string names;
    for (const auto& entry : entries) names += (names.empty() ? "" : ", ") + entry.name;
    return names;
}

void check_size(const char* what, std::size_t size, std::size_t expected) {
    if (size == expected) return;
    std::ostringstream message;
    message << "cloth: " << what << " has " << size << " entries, expected " << expected;
    refuse(message);
}

void check_cloth(const Cloth& cloth) {
    if (!cloth.topology) throw Error(ErrorCode::invalid_argument, "cloth: topology is null, expected a mesh");
    check_size("rest_positions", cloth.rest_positions.size(), cloth.topology->vertex_count());
    check_size("rest_areas", cloth.rest_areas.size(), cloth.topology->triangle_count());
    check_size("inverse_masses", cloth.inverse_masses.size(), cloth.topology->vertex_count());
    if (!(std::isfinite(cloth.time_step) && cloth.time_step > 0.0)) {
        std::ostringstream message;
        message << "cloth: time_step is " << cloth.time_step << ", expected a finite number > 0 (seconds)";
        refuse(message);
    }
}

std::vector<double> parameter_values(const MethodInfo& info, std::span<const Parameter> parameters) {
    std::vector<double> values;
    for (const ParameterInfo& parameter : info.parameters) values.push_back(parameter.standard);
    for (const Parameter& given : parameters) {
        const auto known = std::find_if(info.parameters.begin(), info.parameters.end(),
                                        [&](const ParameterInfo& parameter) { return parameter.name == given.name; });
        std::ostringstream message;
        if (known == info.parameters.end()) {
            message << info.name << ": unknown parameter \"" << given.name << "\", expected one of "
                    << names_of(info.parameters);
            refuse(message);
        }
        if (!(std::isfinite(given.value) && given.value >= known->least)) {
            message << info.name << ": " << given.name << " is " << given.value
                    << ", expected a finite number >= " << known->least;
            refuse(message);
        }
        values[static_cast<std::size_t>(known - info.parameters.begin())] = given.value;
    }
    return values;
}

}  // namespace

std::span<const MethodInfo> all_methods() {
    static const std::vector<MethodInfo> methods = {
        pbd_edges_info(),
        edge_limits_gauss_seidel_info(),
        edge_limits_jacobi_info(),
        pbd_area_gauss_seidel_info(),
        pbd_area_colored_info(),
        pbd_area_jacobi_info(),
        xpbd_edges_info(),
        xpbd_area_info(),
        ring_area_info(),
        continuum_strain_limiting_info(),
        fast_projection_info(),
        hierarchical_constraints_info(),
        hierarchical_pbd_info(),
        nonconforming_edge_midpoint_info(),
        strain_based_dynamics_strain_info(),
        strain_based_dynamics_area_info(),
    };
    return methods;
}

std::unique_ptr<Method> make_method(std::string_view name, const Cloth& cloth, std::span<const Parameter> parameters) {
    const std::span<const MethodInfo> methods = all_methods();
    const auto info =
        std::find_if(methods.begin(), methods.end(), [&](const MethodInfo& method) { return method.name == name; });
    if (info == methods.end()) {
        std::ostringstream message;
        message << "unknown method \"" << name << "\", expected one of " << names_of(methods);
        refuse(message);
    }
    check_cloth(cloth);
    return info->make(cloth, parameter_values(*info, parameters));
}

}  // namespace apsl::methods
