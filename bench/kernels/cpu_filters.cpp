// SPDX-License-Identifier: MIT
#include "cpu_filters.hpp"

#include <apsl/reference.hpp>

#include "reference/conjugate_gradient.hpp"
#include "reference/displacements.hpp"
#include "reference/geometry.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <stdexcept>

namespace apsl::bench {
namespace {

struct Direct {
    explicit Direct(const Cloth& the_cloth) : cloth(the_cloth) {
        const CsrPattern pattern = cloth.topology->csr_pattern(Matrix::consistent);
        shared = pattern.shared;
        rows = reference::zero_matrix<float>(pattern);
        columns = rows;
        factors.analyzePattern(columns);
    }

    std::vector<float> filter(const Parameters& parameters) {
        const std::vector<float>& start = cloth.positions;
        std::vector<float> moved = start;
        for (int sub_step = 0; sub_step < parameters.sub_steps; ++sub_step) {
            reference::triangle_geometries<float>(*cloth.topology, moved, geometry);
            reference::consistent_matrix<float>(*cloth.topology, shared, geometry, cloth.inverse_masses, rows);
            reference::regularize(parameters.regularization, rows);
            // Symmetric: the rows are the columns.
            std::copy(rows.valuePtr(), rows.valuePtr() + rows.nonZeros(), columns.valuePtr());
            factors.factorize(columns);
            if (factors.info() != Eigen::Success) throw std::runtime_error("the factorisation failed");
            area_excess.resize(static_cast<Eigen::Index>(geometry.size()));
            for (std::size_t a = 0; a < geometry.size(); ++a)
                area_excess[static_cast<Eigen::Index>(a)] = geometry[a].area - cloth.rest_areas[a];
            lambda = factors.solve(area_excess);
            reference::displacements<float>(*cloth.topology, geometry, cloth.inverse_masses,
                                            std::span(lambda.data(), geometry.size()), total_correction);
            for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += total_correction[n];
        }
        std::vector<float> velocities(moved.size());
        for (std::size_t n = 0; n < moved.size(); ++n) velocities[n] = (moved[n] - start[n]) / parameters.time_step;
        return velocities;
    }

    const Cloth& cloth;
    std::vector<std::uint8_t> shared;
    std::vector<reference::TriangleGeometry<float>> geometry;
    reference::SparseMatrix<float> rows;
    Eigen::SparseMatrix<float> columns;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<float>> factors;
    reference::TriangleVector<float> area_excess, lambda;
    std::vector<float> total_correction;
};

}  // namespace

Filter reference_filter(const Cloth& cloth) {
    const auto limiter = std::make_shared<reference::BasicStrainLimiter<float>>(cloth.topology);
    return [limiter, &cloth](const Parameters& parameters) {
        std::vector<float> velocities(cloth.positions.size(), 0.0f);
        limiter->enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}}, parameters);
        return velocities;
    };
}

Filter direct_filter(const Cloth& cloth) {
    return
        [direct = std::make_shared<Direct>(cloth)](const Parameters& parameters) { return direct->filter(parameters); };
}

}  // namespace apsl::bench
