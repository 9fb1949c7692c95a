// SPDX-License-Identifier: MIT
#include "reference/geometry.hpp"

#include <Eigen/Geometry>

namespace apsl::reference {

template <class Real>
TriangleGeometry<Real> triangle_geometry(const Triangle& triangle, std::span<const Real> positions) {
    const Vector3<Real> xi = position(positions, triangle[0]);
    const Vector3<Real> xj = position(positions, triangle[1]);
    const Vector3<Real> xk = position(positions, triangle[2]);

    const Vector3<Real> ei = xk - xj;
    const Vector3<Real> ej = xi - xk;
    const Vector3<Real> ek = xj - xi;
    const Vector3<Real> doubled_area_normal = ei.cross(ej);
    const Real doubled_area = doubled_area_normal.norm();

    TriangleGeometry<Real> g;
    g.area = Real(0.5) * doubled_area;
    if (doubled_area > Real(0))
        g.normal = doubled_area_normal / doubled_area;
    else
        g.normal.setZero();
    g.gradients = {g.normal.cross(ei), g.normal.cross(ej), g.normal.cross(ek)};
    return g;
}

template <class Real>
void triangle_geometries(const Topology& topology, std::span<const Real> positions,
                         std::vector<TriangleGeometry<Real>>& geometry) {
    geometry.resize(topology.triangle_count());
    for (std::size_t a = 0; a < geometry.size(); ++a)
        geometry[a] = triangle_geometry(topology.triangles()[a], positions);
}

template TriangleGeometry<double> triangle_geometry(const Triangle&, std::span<const double>);
template TriangleGeometry<float> triangle_geometry(const Triangle&, std::span<const float>);
template void triangle_geometries(const Topology&, std::span<const double>, std::vector<TriangleGeometry<double>>&);
template void triangle_geometries(const Topology&, std::span<const float>, std::vector<TriangleGeometry<float>>&);

}  // namespace apsl::reference
