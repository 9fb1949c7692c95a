// SPDX-License-Identifier: MIT
#include "stability/fuzz/print_case.hpp"

namespace apsl::test {
namespace {

void print(const Parameters& p, std::ostream& out) {
    out << "{.time_step = " << p.time_step << ", .regularization = " << p.regularization
        << ", .sub_steps = " << p.sub_steps << ", .target_area_change = " << p.target_area_change
        << ", .tolerance = " << p.tolerance << ", .max_iterations = " << p.max_iterations
        << ", .adaptive_iterations = " << p.adaptive_iterations
        << ", .first_regularization = " << p.first_regularization << ", .stepping = " << static_cast<int>(p.stepping)
        << ", .enabled = " << p.enabled << "}";
}

const char* array_name(std::vector<double> MovingCloth::* array) {
    return array == &MovingCloth::positions        ? "positions"
           : array == &MovingCloth::velocities     ? "velocities"
           : array == &MovingCloth::inverse_masses ? "inverse_masses"
                                                   : "rest_areas";
}

void print(const MovingCloth& cloth, bool with_alpha, std::ostream& out) {
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        out << "  vertex " << v << ": position";
        for (std::size_t k = 0; k < 3; ++k) out << ' ' << cloth.positions[3 * v + k];
        out << ", velocity";
        for (std::size_t k = 0; k < 3; ++k) out << ' ' << cloth.velocities[3 * v + k];
        out << ", inverse mass " << cloth.inverse_masses[v] << '\n';
    }
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) {
        out << "  triangle " << a << ':';
        for (const std::uint32_t v : cloth.topology->triangles()[a]) out << ' ' << v;
        out << ", rest area " << cloth.rest_areas[a];
        if (with_alpha) out << ", alpha " << cloth.regularization[a];
        out << '\n';
    }
}

}  // namespace

void print(const FuzzCase& c, std::ostream& out) {
    out.precision(9);
    out << "options: " << (c.options.matrix == Matrix::printed ? "printed" : "consistent")
        << (c.options.apply == Apply::assembled_csr ? ", assembled" : ", matrix-free") << ", execution "
        << static_cast<int>(c.options.execution) << ", work-group size " << c.options.work_group_size << ", strides "
        << c.options.position_stride << " and " << c.options.velocity_stride << ", from component to component "
        << c.options.position_component_stride << ", of masses " << c.options.inverse_mass_stride
        << (c.options.regularization_per_triangle ? ", alpha per triangle" : "") << ", kept pressures "
        << c.options.kept_pressures
        << (c.options.solver == Solver::chebyshev ? ", by Chebyshev, bounds for sub-steps " : "")
        << (c.options.solver == Solver::chebyshev ? std::to_string(c.options.bound_period) : "") << ", offset "
        << c.offset << '\n';
    for (std::size_t n = 0; n < c.cloths.size(); ++n) {
        out << "cloth " << n << ":\n";
        print(c.cloths[n], c.options.regularization_per_triangle, out);
    }
    for (std::size_t k = 0; k < c.calls.size(); ++k) {
        const FuzzCall& call = c.calls[k];
        out << "call " << k << (call.carries_on ? ", from where the one before ended, a step later" : "");
        if (call.bad)
            out << ", " << array_name(call.bad->array) << '[' << call.bad->index << "] of cloth " << call.bad->cloth
                << " is " << call.bad->value;
        out << ":\n";
        for (std::size_t n = 0; n < call.parameters.size(); ++n) {
            out << "  cloth " << n << ' ';
            print(call.parameters[n], out);
            out << '\n';
        }
    }
}

}  // namespace apsl::test
