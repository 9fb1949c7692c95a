// SPDX-License-Identifier: MIT
//
// Constraint dynamics with a hierarchy of constraints.
//
// House, DeVaul, Breen: Towards simulating cloth dynamics using interacting particles. International Journal of
// Clothing Science and Technology 8, 1996. What is taken from it is what Han 2015 says of it: inextensibility by
// constraint dynamics, and a hierarchy for fast convergence. All else here is ours:
//   - the levels are those of Müller 2008 (coarsening.hpp); a pass goes from the coarsest to the finest;
//   - on each level the multipliers of all edge lengths C_e = |x_b − x_a| − L are sought at once,
//         (J W Jᵀ + μ D) λ = C,  Δx = −W Jᵀ λ,  J = ∂C/∂x, D = diag(J W Jᵀ), μ = 0.05,
//     by `iterations` of conjugate gradients preconditioned by D. μ keeps the step bounded where edges are redundant,
//     as they are on flat cloth;
//   - what the level's vertices have moved is interpolated to the vertices that the next finer level adds;
//   - edges of coarse levels act only when too long: one that is too short stands for a fold.
#include "methods/all_methods.hpp"

#include "methods/coarsening.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/parameter_values.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace apsl::methods {
namespace {

using Eigen::Vector3f;

constexpr float damping = 0.05f;
constexpr auto least_parallel = static_cast<std::int64_t>(least_parallel_count);

/// Sum over [0, count) of term(i): blocks of fixed size, added in order, so that it does not depend on the threads.
template <class Term>
double ordered_sum(std::int64_t count, const Term& term) {
    constexpr std::int64_t block = 2048;
    const std::int64_t blocks = (count + block - 1) / block;
    std::vector<double> partial(static_cast<std::size_t>(blocks));
#pragma omp parallel for schedule(static) if (count >= least_parallel)
    for (std::int64_t b = 0; b < blocks; ++b) {
        double sum = 0.0;
        for (std::int64_t i = b * block; i < std::min(count, (b + 1) * block); ++i) sum += term(i);
        partial[b] = sum;
    }
    return std::accumulate(partial.begin(), partial.end(), 0.0);
}

/// The linear system of one level, matrix-free.
class LevelSystem {
public:
    LevelSystem(const Cloth& cloth, const Level& level) : vertices_(level.vertices) {
        for (const double w : cloth.inverse_masses) inverse_masses_.push_back(static_cast<float>(w));
        for (std::size_t e = 0; e < level.edges.size(); ++e) {
            const auto& [a, b] = level.edges[e];
            if (cloth.inverse_masses[a] + cloth.inverse_masses[b] == 0.0) continue;
            edges_.push_back(level.edges[e]);
            rest_lengths_.push_back(level.rest_lengths[e]);
        }
        offsets_.assign(inverse_masses_.size() + 1, 0);
        for (const auto& [a, b] : edges_) {
            ++offsets_[a + 1];
            ++offsets_[b + 1];
        }
        std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
        std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
        incident_.resize(2 * edges_.size());
        for (std::uint32_t e = 0; e < edges_.size(); ++e) {
            incident_[next[edges_[e][0]]++] = {e, -1.0f};
            incident_[next[edges_[e][1]]++] = {e, 1.0f};
        }
        const std::size_t count = edges_.size();
        directions_.resize(count);
        for (std::vector<float>* numbers : {&residual_, &direction_, &product_, &multipliers_, &diagonal_})
            numbers->resize(count);
        moved_.resize(inverse_masses_.size(), Vector3f::Zero());
    }

    void solve(std::span<Vector3f> positions, bool only_when_too_long, int iterations) {
        linearize(positions, only_when_too_long);
        conjugate_gradient(iterations);
        gather(multipliers_);
        const auto count = static_cast<std::int64_t>(vertices_.size());
#pragma omp parallel for schedule(static) if (count >= least_parallel)
        for (std::int64_t n = 0; n < count; ++n) {
            const std::uint32_t v = vertices_[n];
            if (inverse_masses_[v] > 0.0f) positions[v] -= moved_[v];
        }
    }

private:
    struct Incident {
        std::uint32_t edge;
        float sign;
    };

    std::int64_t edge_count() const { return static_cast<std::int64_t>(edges_.size()); }

    /// Unit directions J, diagonal D, and C as the first residual; edges that do not act have all three zero.
    void linearize(std::span<const Vector3f> positions, bool only_when_too_long) {
#pragma omp parallel for schedule(static) if (edge_count() >= least_parallel)
        for (std::int64_t e = 0; e < edge_count(); ++e) {
            const auto [a, b] = edges_[e];
            const Vector3f along = positions[b] - positions[a];
            const float length = along.norm();
            const bool acts = length > 0.0f && !(only_when_too_long && length <= rest_lengths_[e]);
            directions_[e] = acts ? Vector3f(along / length) : Vector3f(Vector3f::Zero());
            diagonal_[e] = acts ? inverse_masses_[a] + inverse_masses_[b] : 0.0f;
            residual_[e] = acts ? length - rest_lengths_[e] : 0.0f;
            multipliers_[e] = 0.0f;
        }
    }

    /// moved = W Jᵀ numbers, at each vertex of the level.
    void gather(const std::vector<float>& numbers) {
        const auto count = static_cast<std::int64_t>(vertices_.size());
#pragma omp parallel for schedule(static) if (count >= least_parallel)
        for (std::int64_t n = 0; n < count; ++n) {
            const std::uint32_t v = vertices_[n];
            Vector3f sum = Vector3f::Zero();
            for (std::uint32_t i = offsets_[v]; i < offsets_[v + 1]; ++i)
                sum += incident_[i].sign * numbers[incident_[i].edge] * directions_[incident_[i].edge];
            moved_[v] = inverse_masses_[v] * sum;
        }
    }

    void conjugate_gradient(int iterations) {
        const auto preconditioned = [&](std::int64_t e) {
            return diagonal_[e] > 0.0f ? residual_[e] / diagonal_[e] : 0.0f;
        };
        const auto squared_residual = [&] {
            return ordered_sum(edge_count(), [&](std::int64_t e) { return double{residual_[e]} * preconditioned(e); });
        };
        std::ranges::fill(direction_, 0.0f);
        double gamma = squared_residual();
        double previous = 0.0;
        // Each comparison also ends on numbers that are not finite.
        for (int iteration = 0; iteration < iterations && gamma > 1e-30 && std::isfinite(gamma); ++iteration) {
            const auto beta = static_cast<float>(iteration == 0 ? 0.0 : gamma / previous);
#pragma omp parallel for schedule(static) if (edge_count() >= least_parallel)
            for (std::int64_t e = 0; e < edge_count(); ++e) direction_[e] = preconditioned(e) + beta * direction_[e];
            gather(direction_);
#pragma omp parallel for schedule(static) if (edge_count() >= least_parallel)
            for (std::int64_t e = 0; e < edge_count(); ++e)
                product_[e] = directions_[e].dot(moved_[edges_[e][1]] - moved_[edges_[e][0]]) +
                              damping * diagonal_[e] * direction_[e];
            const double curvature =
                ordered_sum(edge_count(), [&](std::int64_t e) { return double{direction_[e]} * double{product_[e]}; });
            if (!(curvature > 0.0)) return;
            const auto step = static_cast<float>(gamma / curvature);
#pragma omp parallel for schedule(static) if (edge_count() >= least_parallel)
            for (std::int64_t e = 0; e < edge_count(); ++e) {
                multipliers_[e] += step * direction_[e];
                residual_[e] -= step * product_[e];
            }
            previous = gamma;
            gamma = squared_residual();
        }
    }

    std::vector<std::uint32_t> vertices_;
    std::vector<float> inverse_masses_;  // [V]
    std::vector<VertexPair> edges_;
    std::vector<float> rest_lengths_;
    std::vector<std::uint32_t> offsets_;  // [V + 1] into incident_
    std::vector<Incident> incident_;
    std::vector<Vector3f> directions_;
    std::vector<float> residual_, direction_, product_, multipliers_, diagonal_;
    std::vector<Vector3f> moved_;  // [V]
};

class HierarchicalConstraints : public Method {
public:
    HierarchicalConstraints(const Cloth& cloth, int iterations, int level_count, int passes)
        : levels_(coarsen(cloth, level_count)), iterations_(iterations), passes_(passes) {
        for (const Level& level : levels_) systems_.emplace_back(cloth, level);
    }

    void project(std::span<Vector3f> positions) override {
        for (int pass = 0; pass < passes_; ++pass) {
            before_.assign(positions.begin(), positions.end());
            for (std::size_t level = levels_.size(); level-- > 0;) {
                interpolate(levels_[level], before_, positions);
                systems_[level].solve(positions, level > 0, iterations_);
            }
        }
    }

private:
    std::vector<Level> levels_;
    std::vector<LevelSystem> systems_;
    std::vector<Vector3f> before_;
    int iterations_;
    int passes_;
};

std::unique_ptr<Method> make_hierarchical_constraints(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<HierarchicalConstraints>(cloth, whole_number("iterations", values[0]),
                                                     whole_number("levels", values[1]),
                                                     whole_number("passes", values[2]));
}

}  // namespace

MethodInfo hierarchical_constraints_info() {
    return {.name = "hierarchical_constraints",
            .title = "Hierarchical constraint dynamics",
            .citation = "House et al. 1996",
            .parameters = {{"iterations", 10.0, 1.0, {10}},
                           {"levels", 6.0, 1.0, {6}},
                           {"passes", 2.0, 1.0, {1, 2, 5, 10, 20, 40}}},
            .make = make_hierarchical_constraints};
}

}  // namespace apsl::methods
