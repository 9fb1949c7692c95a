// SPDX-License-Identifier: MIT
#include "stability/fuzz/print_case.hpp"

#include "fields.hpp"

#include <tuple>
#include <type_traits>

namespace apsl::test {
namespace {

// What differs from the default, as it is written in C++: ".sub_steps = 4, .stepping = small_steps".
template <class Struct, class... Fields>
void print_changes(const Struct& values, const std::tuple<Fields...>& fields, std::ostream& out) {
    for_each_field(fields, [&](const auto& field) {
        const auto value = values.*field.member;
        if (value == Struct{}.*field.member) return;
        out << '.' << field.name << " = ";
        if constexpr (std::is_enum_v<std::remove_cv_t<decltype(value)>>)
            out << name_of(value);
        else if constexpr (is_vector<std::remove_cv_t<decltype(value)>>)
            for (const auto component : value) out << component << ' ';
        else
            out << value;
        out << ", ";
    });
}

const char* array_name(std::vector<double> MovingCloth::* array) {
    return array == &MovingCloth::positions        ? "positions"
           : array == &MovingCloth::velocities     ? "velocities"
           : array == &MovingCloth::inverse_masses ? "inverse_masses"
                                                   : "rest_areas";
}

void print(const MovingCloth& cloth, const Options& options, std::ostream& out) {
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        out << "  vertex " << v << ": position";
        for (std::size_t k = 0; k < 3; ++k) out << ' ' << cloth.positions[3 * v + k];
        out << ", velocity";
        for (std::size_t k = 0; k < 3; ++k) out << ' ' << cloth.velocities[3 * v + k];
        out << ", inverse mass " << cloth.inverse_masses[v];
        if (options.keeps_contacts)
            for (std::size_t k = 0; k < 8; ++k) out << (k == 0 ? ", contact " : " ") << cloth.contacts[8 * v + k];
        if (options.acceleration_per_vertex)
            for (std::size_t k = 0; k < 3; ++k)
                out << (k == 0 ? ", acceleration " : " ") << cloth.accelerations[3 * v + k];
        for (std::size_t k = 0; k < options.tethers_per_vertex; ++k) {
            const std::size_t t = options.tethers_per_vertex * v + k;
            out << ", tether to " << cloth.tether_anchors[t] << " of " << cloth.tether_lengths[t];
        }
        out << '\n';
    }
    for (std::size_t h = 0; options.bends && 2 * h < cloth.rest_hinges.size(); ++h)
        out << "  hinge " << h << ": " << cloth.rest_hinges[2 * h] << ' ' << cloth.rest_hinges[2 * h + 1] << '\n';
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) {
        out << "  triangle " << a << ':';
        for (const std::uint32_t v : cloth.topology->triangles()[a]) out << ' ' << v;
        out << ", rest area " << cloth.rest_areas[a];
        if (options.regularization_per_triangle) out << ", alpha " << cloth.regularization[a];
        if (options.limits_stretch)
            for (std::size_t k = 0; k < 4; ++k) out << (k == 0 ? ", rest shape " : " ") << cloth.rest_shapes[4 * a + k];
        if (options.stretch_ceiling_per_triangle) out << ", ceiling " << cloth.stretch_ceilings[a];
        out << '\n';
    }
}

}  // namespace

void print(const FuzzCase& c, std::ostream& out) {
    out.precision(9);
    out << "options: ";
    print_changes(c.options, option_fields, out);
    print_changes(c.options, layout_fields, out);
    out << "offset " << c.offset << '\n';
    for (std::size_t n = 0; n < c.cloths.size(); ++n) {
        out << "cloth " << n << ":\n";
        print(c.cloths[n], c.options, out);
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
            print_changes(call.parameters[n], parameter_fields, out);
            out << '\n';
        }
    }
}

}  // namespace apsl::test
