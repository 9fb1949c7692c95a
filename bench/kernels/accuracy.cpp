// SPDX-License-Identifier: MIT
#include "accuracy.hpp"

#include "reference/displacements.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace apsl::bench {
namespace {

std::vector<double> in_double(const std::vector<float>& numbers) {
    return {numbers.begin(), numbers.end()};
}

template <class Real>
double relative_difference(std::span<const Real> got, std::span<const double> want) {
    double squared = 0.0, scale = 0.0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        const double difference = static_cast<double>(got[n]) - want[n];
        squared += difference * difference;
        scale += want[n] * want[n];
    }
    return std::sqrt(squared / scale);
}

}  // namespace

Accuracy::Accuracy(const Cloth& cloth) : cloth_(cloth), inverse_masses_(in_double(cloth.inverse_masses)) {
    const std::vector<double> positions = in_double(cloth.positions);
    reference::triangle_geometries<double>(*cloth.topology, positions, geometry_);
    consistent_ = reference::pressure_matrix<double>(Matrix::consistent, *cloth.topology, geometry_, inverse_masses_);
    area_excess_.resize(static_cast<Eigen::Index>(geometry_.size()));
    for (std::size_t a = 0; a < geometry_.size(); ++a)
        area_excess_[static_cast<Eigen::Index>(a)] = geometry_[a].area - static_cast<double>(cloth.rest_areas[a]);
}

PressureSystem Accuracy::system(double regularization) const {
    reference::SparseMatrix<double> damped = consistent_;
    reference::regularize(regularization, damped);
    const auto entries = damped.nonZeros();
    PressureSystem system;
    system.row_offsets.assign(damped.outerIndexPtr(), damped.outerIndexPtr() + damped.rows() + 1);
    system.columns.assign(damped.innerIndexPtr(), damped.innerIndexPtr() + entries);
    system.values.resize(static_cast<std::size_t>(entries));
    std::transform(damped.valuePtr(), damped.valuePtr() + entries, system.values.begin(),
                   [](double value) { return static_cast<float>(value); });
    system.area_excess.resize(geometry_.size());
    std::transform(area_excess_.begin(), area_excess_.end(), system.area_excess.begin(),
                   [](double value) { return static_cast<float>(value); });
    return system;
}

std::vector<double> Accuracy::displacements(const std::vector<float>& lambda) const {
    std::vector<double> result;
    reference::displacements<double>(*cloth_.topology, geometry_, inverse_masses_, in_double(lambda), result);
    return result;
}

double Accuracy::displacement_error(const std::vector<double>& displacements, double regularization,
                                    int iterations) const {
    reference::SparseMatrix<double> damped = consistent_;
    reference::regularize(regularization, damped);
    reference::ConjugateGradientScratch<double> scratch;
    reference::TriangleVector<double> lambda;
    reference::conjugate_gradient(damped, area_excess_, 0.0, iterations, scratch, lambda);
    std::vector<double> want;
    reference::displacements<double>(*cloth_.topology, geometry_, inverse_masses_,
                                     std::span(lambda.data(), geometry_.size()), want);
    return relative_difference<double>(displacements, want);
}

double Accuracy::residual(const std::vector<double>& displacements) const {
    double squared = 0.0, scale = 0.0;
    for (std::size_t a = 0; a < geometry_.size(); ++a) {
        const double excess = area_excess_[static_cast<Eigen::Index>(a)];
        double left = excess;
        for (std::size_t k = 0; k < 3; ++k)
            left += 0.5 * geometry_[a].gradients[k].dot(
                              reference::position<double>(displacements, cloth_.topology->triangles()[a][k]));
        squared += left * left;
        scale += excess * excess;
    }
    return std::sqrt(squared / scale);
}

double Accuracy::filter_error(const std::vector<float>& velocities, const Parameters& parameters) {
    if (filtered_.empty()) {
        const std::vector<double> positions = in_double(cloth_.positions);
        const std::vector<double> rest_areas = in_double(cloth_.rest_areas);
        filtered_.assign(positions.size(), 0.0);
        reference::StrainLimiter limiter(cloth_.topology);
        limiter.enqueue({positions, filtered_, inverse_masses_, rest_areas, {}}, parameters);
    }
    double worst = 0.0;
    for (std::size_t first = 0; first < velocities.size(); first += filtered_.size())
        worst = std::max(worst,
                         relative_difference<float>(std::span(velocities).subspan(first, filtered_.size()), filtered_));
    return worst;
}

}  // namespace apsl::bench
