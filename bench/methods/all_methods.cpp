// SPDX-License-Identifier: MIT
#include "methods/edge_limits_gauss_seidel.hpp"
#include "methods/edge_limits_jacobi.hpp"
#include "methods/method.hpp"
#include "methods/pbd_area_colored.hpp"
#include "methods/pbd_area_gauss_seidel.hpp"
#include "methods/pbd_area_jacobi.hpp"
#include "methods/pbd_edges.hpp"
#include "methods/ring_area.hpp"
#include "methods/xpbd_area.hpp"
#include "methods/xpbd_edges.hpp"

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

std::vector<double> knob_values(const MethodInfo& info, std::span<const Knob> knobs) {
    std::vector<double> values;
    for (const KnobInfo& knob : info.knobs) values.push_back(knob.standard);
    for (const Knob& given : knobs) {
        const auto known = std::find_if(info.knobs.begin(), info.knobs.end(),
                                        [&](const KnobInfo& knob) { return knob.name == given.name; });
        std::ostringstream message;
        if (known == info.knobs.end()) {
            message << info.name << ": unknown knob \"" << given.name << "\", expected one of " << names_of(info.knobs);
            refuse(message);
        }
        if (!(std::isfinite(given.value) && given.value >= known->least)) {
            message << info.name << ": " << given.name << " is " << given.value
                    << ", expected a finite number >= " << known->least;
            refuse(message);
        }
        values[static_cast<std::size_t>(known - info.knobs.begin())] = given.value;
    }
    return values;
}

}  // namespace

std::span<const MethodInfo> all_methods() {
    static const std::vector<MethodInfo> methods = {
        pbd_edges_info(),          edge_limits_gauss_seidel_info(),
        edge_limits_jacobi_info(), pbd_area_gauss_seidel_info(),
        pbd_area_colored_info(),   pbd_area_jacobi_info(),
        xpbd_edges_info(),         xpbd_area_info(),
        ring_area_info(),
    };
    return methods;
}

std::unique_ptr<Method> make_method(std::string_view name, const Cloth& cloth, std::span<const Knob> knobs) {
    const std::span<const MethodInfo> methods = all_methods();
    const auto info =
        std::find_if(methods.begin(), methods.end(), [&](const MethodInfo& method) { return method.name == name; });
    if (info == methods.end()) {
        std::ostringstream message;
        message << "unknown method \"" << name << "\", expected one of " << names_of(methods);
        refuse(message);
    }
    check_cloth(cloth);
    return info->make(cloth, knob_values(*info, knobs));
}

}  // namespace apsl::methods
