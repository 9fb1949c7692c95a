// SPDX-License-Identifier: MIT
#include "compare/direct_filter.hpp"

#include "reference/direct_solve.hpp"
#include "reference/displacements.hpp"
#include "reference/geometry.hpp"
#include "reference/matrix.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace apsl::compare {
namespace {

struct DirectFilter {
    CsrPattern pattern;
    reference::SparseMatrix<double> matrix;
    Parameters parameters;
    std::vector<double> regularization;  // [T]
    std::vector<reference::TriangleGeometry<double>> geometry;
    std::vector<double> predicted, moved, correction;  // [3V]

    // One displacement towards the rest areas. Returns the greatest |A − A⁰| / A⁰ before it; at or below the target
    // nothing is moved.
    double sub_step(const scenes::ClothState& cloth) {
        reference::triangle_geometries<double>(*cloth.topology, moved, geometry);
        reference::TriangleVector<double> excess(static_cast<Eigen::Index>(geometry.size()));
        double greatest = 0.0;
        for (std::size_t a = 0; a < geometry.size(); ++a) {
            excess[static_cast<Eigen::Index>(a)] = geometry[a].area - cloth.rest_areas[a];
            greatest = std::max(greatest, std::abs(geometry[a].area - cloth.rest_areas[a]) / cloth.rest_areas[a]);
        }
        if (greatest <= static_cast<double>(parameters.target_area_change)) return greatest;
        reference::consistent_matrix<double>(*cloth.topology, pattern.shared, geometry, cloth.inverse_masses, matrix);
        reference::regularize(std::span<const double>(regularization), matrix);
        const reference::TriangleVector<double> lambda = reference::direct_solve(matrix, excess);
        reference::displacements<double>(*cloth.topology, geometry, cloth.inverse_masses,
                                         {lambda.data(), geometry.size()}, correction);
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += correction[i];
        return greatest;
    }

    Stats operator()(scenes::ClothState& cloth) {
        const double time_step = parameters.time_step;
        Stats stats{};
        stats.status = Status::diverged;
        predicted.resize(cloth.positions.size());
        for (std::size_t i = 0; i < predicted.size(); ++i)
            predicted[i] = cloth.positions[i] + time_step * cloth.velocities[i];
        moved = predicted;
        try {
            while (stats.sub_steps < parameters.sub_steps) {
                const double change = sub_step(cloth);
                if (!std::isfinite(change)) return stats;
                if (change <= static_cast<double>(parameters.target_area_change)) break;
                ++stats.sub_steps;
            }
        } catch (const Error&) {
            return stats;
        }
        if (!std::all_of(moved.begin(), moved.end(), [](double x) { return std::isfinite(x); })) return stats;
        for (std::size_t i = 0; i < moved.size(); ++i)
            if (cloth.inverse_masses[i / 3] > 0.0) cloth.velocities[i] += (moved[i] - predicted[i]) / time_step;
        stats.status = Status::ok;
        return stats;
    }
};

}  // namespace

scenes::CustomFilter make_direct_filter(const scenes::ClothState& cloth, const scenes::StrainLimiting& settings) {
    DirectFilter filter;
    filter.pattern = cloth.topology->csr_pattern(Matrix::consistent);
    filter.matrix = reference::zero_matrix<double>(filter.pattern);
    filter.parameters = settings.parameters;
    filter.regularization.assign(settings.regularization.begin(), settings.regularization.end());
    if (filter.regularization.empty())
        filter.regularization.assign(cloth.rest_areas.size(), settings.parameters.regularization);
    return {.name = "strain_limiting",
            .device = "this processor, one thread, double precision",
            .filter = std::move(filter)};
}

}  // namespace apsl::compare
