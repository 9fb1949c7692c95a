// SPDX-License-Identifier: MIT
#include "kernels/arrays.hpp"

#include "host/device_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace apsl::test {
namespace {

// Small and awkward, so that small cloths have several patches.
constexpr std::uint32_t patch_triangles = 37;

host::Adjacency adjacency_of(std::span<const Cloth> cloths, Matrix matrix) {
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const Cloth& cloth : cloths) topologies.push_back(cloth.topology);
    return host::build_adjacency(topologies, matrix, true, true, patch_triangles);
}

std::vector<std::uint32_t> vertex_places_of(const host::Adjacency& adjacency) {
    std::vector<std::uint32_t> places(adjacency.vertex_count);
    for (std::uint32_t place = 0; place < adjacency.vertex_count; ++place)
        places[adjacency.vertex_order[place]] = place;
    return places;
}

std::vector<std::vector<std::uint32_t>> triangle_places_of(const host::Adjacency& adjacency) {
    std::vector<std::vector<std::uint32_t>> places;
    std::uint32_t first_rest_area = 0;
    for (const apslk_cloth& cloth : adjacency.cloths) {
        places.emplace_back(cloth.triangle_count);
        for (std::uint32_t place = cloth.triangle_begin; place < cloth.triangle_begin + cloth.triangle_count; ++place)
            places.back()[adjacency.triangle_order[place] - first_rest_area] = place;
        first_rest_area += cloth.triangle_count;
    }
    return places;
}

std::vector<ScaledSolve> solves_of(std::span<const Cloth> cloths, Matrix matrix, double alpha, bool per_triangle) {
    std::vector<ScaledSolve> solves;
    for (const Cloth& cloth : cloths)
        solves.push_back(scaled_solve(
            cloth, matrix, per_triangle ? cloth.regularization : std::vector<double>(cloth.rest_areas.size(), alpha)));
    return solves;
}

// ‖r‖² of r = √(α D) r̄.
double squared_norm(const ScaledSolve& solve, const std::vector<double>& scaled) {
    double squares = 0.0;
    for (std::size_t a = 0; a < scaled.size(); ++a) squares += solve.scaled_diagonal[a] * scaled[a] * scaled[a];
    return squares;
}

std::vector<apslk_solve_state> fresh_states(std::span<const ScaledSolve> solves) {
    std::vector<apslk_solve_state> states;
    for (const ScaledSolve& solve : solves) {
        apslk_solve_state state = poison<apslk_solve_state>(1)[0];
        state.stopped = 0;
        state.discarded = 0;
        state.iterating = 1;
        state.initial_squared_residual = static_cast<float>(squared_norm(solve, solve.right_hand_side));
        state.solve_iterations = 0;
        state.adaptive_factor = 1.0f;
        states.push_back(state);
    }
    return states;
}

std::vector<cl_float4> predicted_of(std::span<const Cloth> cloths, const std::vector<std::uint32_t>& places) {
    std::vector<cl_float4> all(places.size());
    std::size_t i = 0;
    for (const Cloth& cloth : cloths)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
            all[places[i]] = {
                {static_cast<float>(cloth.positions[3 * v]), static_cast<float>(cloth.positions[3 * v + 1]),
                 static_cast<float>(cloth.positions[3 * v + 2]), static_cast<float>(cloth.inverse_masses[v])}};
    return all;
}

std::vector<cl_float4> accelerations_of(std::span<const Cloth> cloths, const std::vector<std::uint32_t>& places) {
    std::vector<cl_float4> all(places.size());
    std::size_t i = 0;
    for (const Cloth& cloth : cloths)
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i)
            for (std::size_t k = 0; k < 3; ++k)
                all[places[i]].s[k] = static_cast<float>(cloth.accelerations[3 * v + k]);
    return all;
}

// ḡ_k = s √(w_k / 2) g_k in units of 1/32767, (α − 1)/α, and √(α D)/A.
std::vector<Gradients> gradients_of(std::span<const Cloth> cloths, std::span<const ScaledSolve> solves,
                                    const host::Adjacency& adjacency,
                                    const std::vector<std::vector<std::uint32_t>>& places, double alpha,
                                    bool per_triangle) {
    std::vector<Gradients> all(adjacency.triangle_count);
    for (std::size_t c = 0; c < cloths.size(); ++c)
        for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a) {
            const double own_alpha = per_triangle ? cloths[c].regularization[a] : alpha;
            Gradients& out = all[places[c][a]];
            out.shift = static_cast<float>((own_alpha - 1.0) / own_alpha);
            const double scaled_area = solves[c].scale[a] * solves[c].geometry[a].area;
            out.stiffening = scaled_area > 0.0 ? static_cast<float>(1.0 / scaled_area) : 0.0f;
            for (int corner = 0; corner < 3; ++corner)
                for (int k = 0; k < 3; ++k)
                    out.corner[corner].s[k] =
                        static_cast<cl_short>(std::lround(32767.0 * solves[c].scaled_gradients[a][corner][k]));
        }
    return all;
}

// The scaled matrix in the arrays' order of rows and of entries.
std::vector<float> values_of(std::span<const ScaledSolve> solves, const host::Adjacency& adjacency,
                             const std::vector<std::vector<std::uint32_t>>& places) {
    std::vector<float> all(adjacency.columns.size());
    for (std::size_t c = 0; c < solves.size(); ++c) {
        std::vector<Eigen::Index> triangle_at(adjacency.cloths[c].triangle_count);
        for (std::size_t a = 0; a < triangle_at.size(); ++a)
            triangle_at[places[c][a] - adjacency.cloths[c].triangle_begin] = static_cast<Eigen::Index>(a);
        for (std::size_t a = 0; a < triangle_at.size(); ++a)
            for (std::uint32_t e = adjacency.row_offsets[places[c][a]]; e < adjacency.row_offsets[places[c][a] + 1];
                 ++e)
                all[e] = static_cast<float>(
                    solves[c].rows.coeff(static_cast<Eigen::Index>(a),
                                         triangle_at[adjacency.columns[e] - adjacency.cloths[c].triangle_begin]));
    }
    return all;
}

std::vector<float> placed(std::span<const Cloth> cloths, std::vector<double> Cloth::* numbers, std::size_t width,
                          Placement placement) {
    std::vector<float> all = poison<float>(placement.offset);
    for (const Cloth& cloth : cloths)
        for (std::size_t n = 0; n < (cloth.*numbers).size(); n += width) {
            for (std::size_t k = 0; k < width; ++k) all.push_back(static_cast<float>((cloth.*numbers)[n + k]));
            const std::vector<float> gap = poison<float>(placement.stride - width);
            all.insert(all.end(), gap.begin(), gap.end());
        }
    all.resize(all.size() - (placement.stride - width));
    return all;
}

// A mesh may have no hinges, and a buffer is never empty.
template <class Value>
std::vector<Value> never_empty(std::vector<Value> values) {
    if (values.empty()) values.resize(1);
    return values;
}

}  // namespace

Arrays::Arrays(std::span<const Cloth> source_cloths, Matrix matrix, const Parameters& p, std::uint32_t group_count,
               bool alpha_per_triangle, Placement position, Placement velocity)
    : sources(source_cloths),
      solves(solves_of(source_cloths, matrix, p.regularization, alpha_per_triangle)),
      adjacency(adjacency_of(source_cloths, matrix)),
      vertex_places(vertex_places_of(adjacency)),
      triangle_places(triangle_places_of(adjacency)),
      groups(group_count),
      position_placement(position),
      velocity_placement(velocity),
      array_offset(position.offset),
      cloths(adjacency.cloths),
      parameters(std::vector<apslk_parameters>(source_cloths.size(), host::device_parameters(p))),
      states(fresh_states(solves)),
      stats(std::vector<apslk_stats>(source_cloths.size(), apslk_stats{})),
      partials(poison<float>(source_cloths.size() * APSLK_PARTIAL_KINDS * group_count)),
      vertex_order(adjacency.vertex_order),
      triangle_order(adjacency.triangle_order),
      triangles(adjacency.triangles),
      corner_offsets(adjacency.corner_offsets),
      corners(adjacency.corners),
      row_offsets(adjacency.row_offsets),
      columns(adjacency.columns),
      shared(adjacency.shared),
      patches(adjacency.patches),
      patch_vertices(adjacency.patch_vertices),
      local_triangles(adjacency.local_triangles),
      moved(predicted_of(source_cloths, vertex_places)),
      motion(poison<cl_float4>(adjacency.vertex_count)),
      total_correction(poison<cl_float4>(adjacency.vertex_count)),
      gradients(with_stretches(
          gradients_of(source_cloths, solves, adjacency, triangle_places, p.regularization, alpha_per_triangle))),
      residual(
          with_stretches(over_triangles([&](std::size_t c, std::size_t a) { return solves[c].right_hand_side[a]; }))),
      scaled_diagonal(
          with_stretches(over_triangles([&](std::size_t c, std::size_t a) { return solves[c].scaled_diagonal[a]; }))),
      values(values_of(solves, adjacency, triangle_places)),
      product(poisoned_triangles()),
      direction(poison<float>(2 * adjacency.triangle_count)),
      direction_product(poison<float>(adjacency.triangle_count)),
      pressure(poison<float>(2 * adjacency.triangle_count)),
      vertex_bounds(poison<float>(adjacency.vertex_count)),
      start_errors(with_stretches(poisoned_triangles(), APSLK_HELD_EXCESS)),
      ordered_rest(ordered_rest_values()),
      ordered_scaling(over_triangles([&](std::size_t c, std::size_t a) { return sources[c].regularization[a]; })),
      caller_positions(placed(sources, &Cloth::positions, 3, position)),
      caller_velocities(placed(sources, &Cloth::velocities, 3, velocity)),
      inverse_masses(placed(sources, &Cloth::inverse_masses, 1, {1, array_offset})),
      rest_areas(placed(sources, &Cloth::rest_areas, 1, {1, array_offset})),
      regularization(placed(sources, &Cloth::regularization, 1, {1, array_offset})),
      hinges(never_empty(adjacency.hinges)),
      hinge_offsets(adjacency.hinge_offsets),
      hinge_order(never_empty(adjacency.hinge_order)),
      hinge_corner_offsets(adjacency.hinge_corner_offsets),
      hinge_corners(never_empty(adjacency.hinge_corners)),
      hinge_gradients(poison<cl_float4>(2 * hinges.size())),
      hinge_moments(poison<float>(hinges.size())),
      bending_residuals(poison<cl_float4>(adjacency.vertex_count)),
      bending_steps(poison<cl_float4>(adjacency.vertex_count)),
      next_bending_steps(poison<cl_float4>(adjacency.vertex_count)),
      rest_hinges(never_empty(placed(sources, &Cloth::rest_hinges, 2, {2, array_offset}))),
      rest_shapes(placed(sources, &Cloth::rest_shapes, 4, {4, array_offset})),
      stretch_ceilings(placed(sources, &Cloth::stretch_ceilings, 1, {1, array_offset})),
      contacts(placed(sources, &Cloth::contacts, 8, {8, array_offset})),
      accelerations(accelerations_of(source_cloths, vertex_places)),
      caller_accelerations(placed(sources, &Cloth::accelerations, 3, position)) {
    for (std::size_t c = 0; c < cloth_count(); ++c) {
        const std::vector<double>& b = solves[c].right_hand_side;
        write_partial_sum(c, APSLK_PARTIAL_RESIDUAL_EVEN, squared_norm(solves[c], b));
        write_partial_sum(c, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN,
                          std::inner_product(b.begin(), b.end(), b.begin(), 0.0));
    }
}

std::vector<float> Arrays::ordered_rest_values() const {
    std::vector<float> all = over_triangles([&](std::size_t c, std::size_t a) { return sources[c].rest_areas[a]; });
    const auto append = [&](const auto& value) {
        const std::vector<float> run = over_triangles(value);
        all.insert(all.end(), run.begin(), run.end());
    };
    for (const std::size_t n : {0u, 1u, 3u})
        append([&](std::size_t c, std::size_t a) { return sources[c].rest_shapes[4 * a + n]; });
    append([&](std::size_t c, std::size_t a) { return sources[c].stretch_ceilings[a]; });
    return all;
}

std::vector<double> Arrays::of_cloth(const std::vector<float>& per_triangle, std::size_t cloth) const {
    std::vector<double> numbers;
    for (const std::uint32_t place : triangle_places[cloth]) numbers.push_back(per_triangle[place]);
    return numbers;
}

std::vector<float> Arrays::padding_of(const std::vector<float>& per_triangle) const {
    std::vector<float> padding;
    for (std::size_t c = 0; c < cloth_count(); ++c) {
        const std::size_t end =
            c + 1 < cloth_count() ? adjacency.cloths[c + 1].triangle_begin : adjacency.triangle_count;
        for (std::size_t n = adjacency.cloths[c].triangle_begin + adjacency.cloths[c].triangle_count; n < end; ++n)
            padding.push_back(per_triangle[n]);
    }
    return padding;
}

std::vector<float> Arrays::poisoned_triangles() const {
    return over_triangles([](std::size_t, std::size_t) { return static_cast<double>(poison<float>(1)[0]); });
}

std::vector<float> Arrays::over_triangles(const std::function<double(std::size_t, std::size_t)>& value) const {
    std::vector<float> all(adjacency.triangle_count, 0.0f);
    for (std::size_t c = 0; c < cloth_count(); ++c)
        for (std::size_t a = 0; a < triangle_places[c].size(); ++a)
            all[triangle_places[c][a]] = static_cast<float>(value(c, a));
    return all;
}

double Arrays::unscaled_squared(std::size_t cloth, const std::vector<double>& scaled) const {
    return squared_norm(solves[cloth], scaled);
}

std::vector<double> Arrays::partials_of(std::size_t cloth, int kind) const {
    const std::vector<float> all = partials.read();
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>((cloth * APSLK_PARTIAL_KINDS + kind) * groups);
    return {begin, begin + groups};
}

void Arrays::write_partials(std::size_t cloth, int kind, const std::vector<double>& numbers) {
    std::vector<float> all = partials.read();
    for (std::size_t g = 0; g < groups; ++g)
        all[(cloth * APSLK_PARTIAL_KINDS + kind) * groups + g] = static_cast<float>(numbers[g]);
    partials.write(all);
}

void Arrays::write_partial_sum(std::size_t cloth, int kind, double sum) {
    std::vector<double> numbers(groups, 0.0);
    numbers[0] = sum;
    write_partials(cloth, kind, numbers);
}

void Arrays::edit_states(const std::function<void(apslk_solve_state&)>& edit) {
    std::vector<apslk_solve_state> edited = states.read();
    for (apslk_solve_state& state : edited) edit(state);
    states.write(edited);
}

}  // namespace apsl::test
