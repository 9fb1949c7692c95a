// SPDX-License-Identifier: MIT
#include "reference/displacements.hpp"

namespace apsl::reference {

template <class Real>
void displacements(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                   std::span<const Real> inverse_masses, std::span<const Real> lambda,
                   std::vector<Real>& displacements) {
    displacements.assign(3 * topology.vertex_count(), Real(0));
    for (std::size_t i = 0; i < topology.vertex_count(); ++i) {
        if (inverse_masses[i] == Real(0)) continue;
        Vector3<Real> sum = Vector3<Real>::Zero();
        for (std::uint32_t n = topology.corner_offsets()[i]; n < topology.corner_offsets()[i + 1]; ++n) {
            const Corner corner = topology.corners()[n];
            sum += lambda[corner / 3] * geometry[corner / 3].gradients[corner % 3];
        }
        Eigen::Map<Vector3<Real>>(displacements.data() + 3 * i) = -inverse_masses[i] * sum;
    }
}

template void displacements(const Topology&, std::span<const TriangleGeometry<double>>, std::span<const double>,
                            std::span<const double>, std::vector<double>&);
template void displacements(const Topology&, std::span<const TriangleGeometry<float>>, std::span<const float>,
                            std::span<const float>, std::vector<float>&);

}  // namespace apsl::reference
