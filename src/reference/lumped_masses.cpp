// SPDX-License-Identifier: MIT
#include "finite.hpp"
#include "reference/check.hpp"
#include "reference/geometry.hpp"
#include "reference/hinges.hpp"
#include "reference/stretch_rows.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

namespace apsl::reference {

template <class Real>
std::vector<Real> areas(const Topology& topology, std::span<const Real> positions) {
    check_size("positions", positions.size(), 3 * topology.vertex_count());
    std::vector<Real> result(topology.triangle_count());
    for (std::size_t a = 0; a < result.size(); ++a)
        result[a] = triangle_geometry(topology.triangles()[a], positions).area;
    return result;
}

template <class Real>
std::vector<Real> rest_shapes(const Topology& topology, std::span<const Real> positions) {
    check_size("positions", positions.size(), 3 * topology.vertex_count());
    std::vector<Real> result;
    result.reserve(4 * topology.triangle_count());
    for (const Triangle& triangle : topology.triangles()) {
        const RestShape<Real> shape = rest_shape(triangle, positions);
        result.insert(result.end(), {shape[1][0], shape[1][1], shape[2][0], shape[2][1]});
    }
    return result;
}

template <class Real>
std::vector<Real> rest_hinges(const Topology& topology, std::span<const Real> positions) {
    check_size("positions", positions.size(), 3 * topology.vertex_count());
    std::vector<Real> result;
    result.reserve(2 * topology.hinge_count());
    for (const Hinge& hinge : topology.hinges()) {
        const RestHinge<Real> rest = rest_hinge(hinge, positions);
        result.insert(result.end(), {rest.angle, rest.shape});
    }
    return result;
}

template <class Real>
std::vector<Real> inverse_masses(const Topology& topology, std::span<const Real> rest_areas, Real density) {
    check_size("rest_areas", rest_areas.size(), topology.triangle_count());
    check_values("rest_areas", "triangle", rest_areas, "a finite number >= 0 (m2)",
                 [](Real area) { return area >= Real(0); });
    if (!(is_finite(density) && density > Real(0)))
        throw Error(ErrorCode::invalid_argument,
                    "density is " + std::to_string(density) + ", expected a finite number > 0 (kg/m2)");
    std::vector<Real> masses(topology.vertex_count(), Real(0));
    for (std::size_t a = 0; a < rest_areas.size(); ++a)
        for (const std::uint32_t v : topology.triangles()[a]) masses[v] += density * rest_areas[a] / Real(3);
    std::vector<Real> inverse(masses.size(), Real(0));
    for (std::size_t v = 0; v < masses.size(); ++v)
        if (masses[v] > Real(0)) inverse[v] = Real(1) / masses[v];
    return inverse;
}

template std::vector<double> areas(const Topology&, std::span<const double>);
template std::vector<float> areas(const Topology&, std::span<const float>);
template std::vector<double> rest_shapes(const Topology&, std::span<const double>);
template std::vector<float> rest_shapes(const Topology&, std::span<const float>);
template std::vector<double> rest_hinges(const Topology&, std::span<const double>);
template std::vector<float> rest_hinges(const Topology&, std::span<const float>);
template std::vector<double> inverse_masses(const Topology&, std::span<const double>, double);
template std::vector<float> inverse_masses(const Topology&, std::span<const float>, float);

}  // namespace apsl::reference
