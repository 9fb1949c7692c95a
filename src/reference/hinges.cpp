// SPDX-License-Identifier: MIT
#include "reference/hinges.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace apsl::reference {

template <class Real>
HingeGeometry<Real> hinge_geometry(const Hinge& hinge, std::span<const Real> positions) {
    const Vector3<Real> e0 = position(positions, hinge[0]);
    const Vector3<Real> edge = position(positions, hinge[1]) - e0;
    const Vector3<Real> to_o0 = position(positions, hinge[2]) - e0, to_o1 = position(positions, hinge[3]) - e0;
    // Normals of the doubled areas.
    const Vector3<Real> n0 = edge.cross(to_o0), n1 = to_o1.cross(edge);
    const Real length = edge.norm(), squared0 = n0.squaredNorm(), squared1 = n1.squaredNorm();
    HingeGeometry<Real> g;
    g.angle = Real(0);
    g.gradients.fill(Vector3<Real>::Zero());
    if (!(length > Real(0) && squared0 > Real(0) && squared1 > Real(0))) return g;
    g.angle = std::atan2(n0.cross(n1).dot(edge) / length, n0.dot(n1));
    const Vector3<Real> at_o0 = -length / squared0 * n0, at_o1 = -length / squared1 * n1;
    // Where along the edge the opposite vertices lie.
    const Real t0 = to_o0.dot(edge) / (length * length), t1 = to_o1.dot(edge) / (length * length);
    g.gradients = {-(Real(1) - t0) * at_o0 - (Real(1) - t1) * at_o1, -t0 * at_o0 - t1 * at_o1, at_o0, at_o1};
    return g;
}

template <class Real>
RestHinge<Real> rest_hinge(const Hinge& hinge, std::span<const Real> rest_positions) {
    const Real first_area = triangle_geometry<Real>({hinge[0], hinge[1], hinge[2]}, rest_positions).area;
    const Real second_area = triangle_geometry<Real>({hinge[1], hinge[0], hinge[3]}, rest_positions).area;
    if (!(first_area > Real(0) && second_area > Real(0))) return {Real(0), Real(0)};
    const Vector3<Real> edge = position(rest_positions, hinge[1]) - position(rest_positions, hinge[0]);
    return {hinge_geometry(hinge, rest_positions).angle, edge.squaredNorm() / (first_area + second_area)};
}

template <class Real>
Real bend(Real angle, Real rest_angle) {
    return std::remainder(angle - rest_angle, Real(2) * std::numbers::pi_v<Real>);
}

template <class Real>
Real hinge_energy(const RestHinge<Real>& rest, Real rigidity, Real angle) {
    const Real change = bend(angle, rest.angle);
    return rigidity * rest.shape * change * change / Real(2);
}

#define APSL_INSTANTIATE(Real)                                                        \
    template HingeGeometry<Real> hinge_geometry(const Hinge&, std::span<const Real>); \
    template RestHinge<Real> rest_hinge(const Hinge&, std::span<const Real>);         \
    template Real bend(Real, Real);                                                   \
    template Real hinge_energy(const RestHinge<Real>&, Real, Real);
APSL_INSTANTIATE(double)
APSL_INSTANTIATE(float)
#undef APSL_INSTANTIATE

}  // namespace apsl::reference
