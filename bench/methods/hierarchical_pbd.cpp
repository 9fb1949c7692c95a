// SPDX-License-Identifier: MIT
//
// Hierarchical position based dynamics: distance constraints on several levels of the mesh (coarsening.hpp), solved
// from the coarsest level to the finest. On each level `iterations` of Gauss–Seidel (coloured) over its edges,
//     Δx_a = +w_a / (w_a + w_b) C d,  Δx_b = −w_b / (w_a + w_b) C d,  C = |x_b − x_a| − L,  d = (x_b − x_a) / |x_b −
//     x_a|,
// then how far the level's vertices have moved since the start is interpolated to those that the next finer level adds.
// Edges of coarse levels act only when too long: one that is too short stands for a fold that the level cannot show.
// Every stiffness is 1.
//
// M. Müller: Hierarchical Position Based Dynamics. VRIPHYS 2008.
#include "methods/all_methods.hpp"

#include "methods/coarsening.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/edge_constraints.hpp"
#include "methods/parameter_values.hpp"

namespace apsl::methods {
namespace {

struct EdgeLevel {
    std::vector<EdgeConstraint> constraints;
    Coloring coloring;
};

EdgeLevel edge_level(const Cloth& cloth, const Level& level) {
    EdgeLevel result;
    for (std::size_t e = 0; e < level.edges.size(); ++e) {
        const auto& [a, b] = level.edges[e];
        const std::array<float, 2> inverse_masses{static_cast<float>(cloth.inverse_masses[a]),
                                                  static_cast<float>(cloth.inverse_masses[b])};
        if (inverse_masses != std::array<float, 2>{})
            result.constraints.push_back({level.edges[e], inverse_masses, level.rest_lengths[e]});
    }
    result.coloring = sort_by_color(result.constraints, cloth.topology->vertex_count(), &EdgeConstraint::vertices);
    return result;
}

class HierarchicalPbd : public Method {
public:
    HierarchicalPbd(const Cloth& cloth, int iterations, int level_count)
        : levels_(coarsen(cloth, level_count)), iterations_(iterations) {
        for (const Level& level : levels_) edge_levels_.push_back(edge_level(cloth, level));
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        before_.assign(positions.begin(), positions.end());
        for (std::size_t level = levels_.size(); level-- > 0;) {
            // Absent on the coarsest level, which lacks no vertex of its own.
            interpolate(levels_[level], before_, positions);
            relax(edge_levels_[level], level > 0, positions);
        }
    }

private:
    void relax(EdgeLevel& level, bool only_when_too_long, std::span<Eigen::Vector3f> positions) const {
        sweep_colors(level.constraints, level.coloring, iterations_, [&](const EdgeConstraint& edge) {
            const auto [a, b] = edge.vertices;
            const auto [wa, wb] = edge.inverse_masses;
            const Eigen::Vector3f along = positions[b] - positions[a];
            const float length = along.norm();
            if (!(length > 0.0f) || (only_when_too_long && length <= edge.rest_length)) return;
            const Eigen::Vector3f step = (length - edge.rest_length) / (length * (wa + wb)) * along;
            if (wa > 0.0f) positions[a] += wa * step;
            if (wb > 0.0f) positions[b] -= wb * step;
        });
    }

    std::vector<Level> levels_;
    std::vector<EdgeLevel> edge_levels_;
    std::vector<Eigen::Vector3f> before_;
    int iterations_;
};

std::unique_ptr<Method> make_hierarchical_pbd(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<HierarchicalPbd>(cloth, whole_number("iterations", values[0]),
                                             whole_number("levels", values[1]));
}

}  // namespace

MethodInfo hierarchical_pbd_info() {
    return {.name = "hierarchical_pbd",
            .title = "Hierarchical PBD",
            .citation = "Müller 2008",
            .parameters = {iterations_parameter(10), {"levels", 6.0, 1.0, {6}}},
            .make = make_hierarchical_pbd};
}

}  // namespace apsl::methods
