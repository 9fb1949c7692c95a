// SPDX-License-Identifier: MIT
#include "reference/stretch_rows.hpp"

#include "chebyshev_products.hpp"
#include "kernels/launch.hpp"
#include "reference/chebyshev.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr double margin = 0.05, excess_taken = 0.6, weak_row_share = 0.1, bound_margin = 1.02;

Build with_stretches(std::uint32_t work_group_size) {
    return {.work_group_size = work_group_size, .chebyshev = true, .limits_stretch = true};
}

/// The area rows of a cloth and then its stretch rows, each of true gradients, as the kernels are to have them.
struct BothRows {
    std::vector<reference::ConstraintRow<double>> rows;
    std::vector<double> share, stretch;
    std::vector<std::uint8_t> weak;       ///< and asked for less than it demands
    std::vector<std::uint8_t> weak_area;  ///< likewise
    reference::RowSystem<double> system;
    reference::TriangleVector<double> bound;
};

std::array<double, 3> corner_masses(const Cloth& cloth, std::size_t a) {
    const Triangle& t = cloth.topology->triangles()[a];
    return {cloth.inverse_masses[t[0]], cloth.inverse_masses[t[1]], cloth.inverse_masses[t[2]]};
}

BothRows both_rows(const Cloth& cloth) {
    const std::size_t count = cloth.rest_areas.size();
    BothRows both;
    both.rows.resize(2 * count);
    std::vector<std::uint32_t> owners(2 * count);
    for (std::size_t a = 0; a < count; ++a) {
        owners[a] = owners[count + a] = static_cast<std::uint32_t>(a);
        const Triangle& triangle = cloth.topology->triangles()[a];
        reference::ConstraintRow<double>& area = both.rows[a];
        reference::ConstraintRow<double>& limited = both.rows[count + a];
        area =
            reference::area_row(reference::triangle_geometry<double>(triangle, cloth.positions), cloth.rest_areas[a]);
        const std::array<double, 3> w = corner_masses(cloth, a);
        const double excess = std::exchange(area.value, reference::asked_of_area_row(area, cloth.rest_areas[a], w));
        both.weak_area.push_back(area.value != excess ? 1 : 0);
        limited = {0.0, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}};
        both.share.push_back(0.0);
        both.weak.push_back(0);
        const auto shape = reference::rest_shape<double>(cloth.rest_shapes, a);
        const double ceiling = cloth.stretch_ceilings[a];
        both.stretch.push_back(reference::principal_stretch<double>(shape, triangle, cloth.positions).value);
        if (ceiling == 0.0 || both.stretch[a] <= ceiling - margin) continue;
        const auto plain =
            reference::stretch_row<double>(shape, triangle, cloth.positions, cloth.rest_areas[a], ceiling);
        limited = reference::orthogonalized(plain, area, w);
        both.share[a] = reference::share_of_other(plain, area, w);
        const double size = reference::weighted_product(plain, plain, w),
                     left = std::min(reference::movable_share(plain, w) * size,
                                     reference::weighted_product(limited, limited, w));
        both.weak[a] = left < weak_row_share * size ? 1 : 0;
        limited.value = reference::asked_of_row(excess_taken * limited.value, left, size);
    }
    both.system = reference::row_system<double>(*cloth.topology, both.rows, owners, cloth.inverse_masses);
    both.bound = bound_margin * reference::row_bound<double>(both.system, cloth.inverse_masses);
    return both;
}

/// Rows assembled, bounded, and assembled again with that bound, as a call does.
void assemble(Arrays& arrays, const Build& build) {
    arrays.vertex_bounds.write(std::vector<float>(arrays.vertex_bounds.size(), 1.0f));
    launch::assemble_gradients(arrays, build);
    launch::bound_vertices(arrays, build);
    launch::assemble_gradients(arrays, build);
}

std::vector<double> second_run_of_cloth(const Arrays& arrays, const std::vector<float>& rows, std::size_t c) {
    return arrays.of_cloth({rows.begin() + arrays.adjacency.triangle_count, rows.end()}, c);
}

}  // namespace

TEST_CASE("rest_shapes: the reference's, zeros without area", "[rest_shapes]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        Mesh flat;
        flat.positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0};
        flat.triangles = {{0, 1, 2}, {0, 1, 3}};
        std::vector<Cloth> cloths{make_cloth(grid(9, 7, 1.0, 1.0, Diagonals::random), 1), make_cloth(flat, 2)};
        cloths[1].positions = flat.positions;
        Arrays arrays(cloths, Matrix::consistent, paper_setting, 3, false, {4, 5});
        arrays.rest_shapes.write(poison<float>(arrays.rest_shapes.size()));
        launch::rest_shapes(arrays, with_stretches(group));
        const std::vector<float> got = arrays.rest_shapes.read();
        std::size_t n = arrays.array_offset;
        for (const Cloth& cloth : cloths)
            for (const double want : reference::rest_shapes<double>(*cloth.topology, cloth.positions)) {
                CAPTURE(n);
                CHECK(static_cast<double>(got[n++]) == Approx(want).epsilon(1e-4).margin(1e-4));
            }
        CHECK(n == got.size());
        for (std::size_t k = n - 8; k < n - 4; ++k) CHECK(got[k] == 0.0f);
        for (std::size_t i = 0; i < arrays.array_offset; ++i) CHECK(std::isnan(got[i]));
    }
}

TEST_CASE("order_stretch_limits: turned to three numbers with the same stretches; what has no shape has no ceiling",
          "[order_stretch_limits]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        std::vector<Cloth> cloths{make_cloth(grid(9, 7, 1.0, 1.0, Diagonals::random), 1), make_cloth(book(4), 2)};
        for (Cloth& cloth : cloths) cloth.rest_shapes = random_numbers(cloth.rest_shapes.size(), -3.0, 3.0, 7);
        std::fill_n(cloths[0].rest_shapes.begin(), 4, 0.0);
        cloths[0].stretch_ceilings[1] = 1.001;  // counts as 1.01
        cloths[0].rest_areas[2] = 0.0;
        cloths[0].rest_shapes[12] = std::numeric_limits<double>::quiet_NaN();
        Arrays arrays(cloths, Matrix::consistent, paper_setting, 2, false, {3, 5});
        std::vector<float> ordered = poison<float>(arrays.ordered_rest.size());
        const std::vector<float> areas =
            arrays.over_triangles([&](std::size_t c, std::size_t a) { return cloths[c].rest_areas[a]; });
        std::copy(areas.begin(), areas.end(), ordered.begin());
        arrays.ordered_rest.write(ordered);
        launch::order_stretch_limits(arrays, with_stretches(group));
        ordered = arrays.ordered_rest.read();
        const auto run = [&](std::size_t kind, std::size_t c, std::size_t a) {
            return static_cast<double>(ordered[kind * arrays.adjacency.triangle_count + arrays.triangle_places[c][a]]);
        };
        for (std::size_t c = 0; c < cloths.size(); ++c)
            for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a) {
                CAPTURE(c, a);
                if (c == 0 && a == 3) {
                    CHECK(std::isnan(run(0, c, a)));  // what a call then finds and names
                    continue;
                }
                const bool none = c == 0 && (a == 0 || a == 2);
                const double* M = cloths[c].rest_shapes.data() + 4 * a;
                const double m00 = run(1, c, a), m01 = run(2, c, a), m11 = run(3, c, a);
                // M Mᵀ is what singular values of F depend on.
                const double scale = none ? 0.0 : 1.0;
                CHECK(m00 * m00 + m01 * m01 == Approx(scale * (M[0] * M[0] + M[1] * M[1])).epsilon(1e-5).margin(1e-5));
                CHECK(m01 * m11 == Approx(scale * (M[0] * M[2] + M[1] * M[3])).epsilon(1e-5).margin(1e-5));
                CHECK(m11 * m11 == Approx(scale * (M[2] * M[2] + M[3] * M[3])).epsilon(1e-5).margin(1e-5));
                const double ceiling = c == 0 && a == 1 ? 1.01 : cloths[c].stretch_ceilings[a];
                CHECK(run(4, c, a) == Approx(scale * ceiling).epsilon(1e-6));
            }
    }
}

TEST_CASE("stretch rows: gradients, bound, right-hand side and share are the reference's",
          "[assemble_gradients][bound_vertices]") {
    for (const std::uint32_t group : {1u, 64u}) {
        CAPTURE(group);
        std::vector<Cloth> cloths = every_kind_of_mesh();
        // Triangles at pins are small for their rest areas, as where pins come near to one another.
        for (Cloth& cloth : cloths)
            for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) {
                const std::array<double, 3> w = corner_masses(cloth, a);
                if (std::count(w.begin(), w.end(), 0.0) > 0) cloth.rest_areas[a] *= 20.0;
            }
        Arrays arrays(cloths, Matrix::consistent, {.sub_steps = 1}, 3);
        assemble(arrays, with_stretches(group));
        const std::vector<Gradients> gradients = arrays.gradients.read();
        const std::size_t run = arrays.adjacency.triangle_count;
        std::size_t at_work = 0, weak = 0, weak_areas = 0;
        for (std::size_t c = 0; c < cloths.size(); ++c) {
            const BothRows want = both_rows(cloths[c]);
            const std::size_t count = cloths[c].rest_areas.size();
            const std::vector<double> areas = arrays.of_cloth(arrays.scaled_diagonal.read(), c);
            const std::vector<double> bounds = second_run_of_cloth(arrays, arrays.scaled_diagonal.read(), c);
            const std::vector<double> excesses = arrays.of_cloth(arrays.residual.read(), c);
            const std::vector<double> values = second_run_of_cloth(arrays, arrays.residual.read(), c);
            for (std::size_t a = 0; a < count; ++a) {
                CAPTURE(c, a);
                const Gradients& row = gradients[run + arrays.triangle_places[c][a]];
                const auto n = static_cast<Eigen::Index>(a), s = static_cast<Eigen::Index>(count + a);
                const auto true_bound = [&](Eigen::Index r) {
                    // The kernels' gradients are twice the true ones: ½ Σ w |g|² is twice Σ w |∇C|².
                    return 2.0 * want.bound[r] * want.system.scale[r] * want.system.scale[r];
                };
                CHECK(areas[a] == Approx(true_bound(n)).epsilon(3e-2).margin(1e-12));
                if (areas[a] > 0.0)
                    CHECK(excesses[a] == Approx(want.rows[a].value / std::sqrt(areas[a])).epsilon(1e-3).margin(1e-5));
                weak_areas += want.weak_area[a];
                if (!(want.system.scale[s] > 0.0)) {
                    CHECK(gradients[arrays.triangle_places[c][a]].shift == 0.0f);  // nothing reads it
                    continue;
                }
                ++at_work;
                weak += want.weak[a] != 0 && want.rows[count + a].value > 0.0 ? 1u : 0u;
                CHECK(gradients[arrays.triangle_places[c][a]].shift == 1.0f);
                // The eigenvalue may come out up to 1.04 times too high.
                CHECK(bounds[a] == Approx(true_bound(s)).epsilon(3e-2));
                const double root = std::sqrt(bounds[a]);
                CHECK(values[a] == Approx(want.rows[count + a].value / root).epsilon(1e-3).margin(1e-5));
                CHECK(static_cast<double>(row.shift) ==
                      Approx(want.share[a] * std::sqrt(areas[a]) / root).epsilon(1e-3).margin(1e-4));
                CHECK(static_cast<double>(row.stiffening) ==
                      Approx(root / (cloths[c].rest_areas[a] * want.stretch[a])).epsilon(1e-4));
                for (std::size_t k = 0; k < 3; ++k)
                    for (int axis = 0; axis < 3; ++axis)
                        // ḡ = √(w/2) g/√B, g twice the true gradient.
                        CHECK(row.corner[k].s[axis] / 32767.0 ==
                              Approx(std::sqrt(2.0 * corner_masses(cloths[c], a)[k]) *
                                     want.rows[count + a].gradients[k][axis] / root)
                                  .margin(1e-3));
            }
        }
        CHECK(at_work > 100);
        CHECK(weak > 2);
        CHECK(weak_areas > 2);
    }
}

TEST_CASE("stretch rows: what stands over a ceiling is asked for slowly", "[assemble_gradients]") {
    const Parameters thirty_parts{.sub_steps = 31, .most_sub_steps = 62, .stepping = Stepping::small_steps};
    // The sub-steps that calls before asked for, over the 31 of this one, and how fast that is.
    for (const auto& [group, asked, asked_again] :
         {std::tuple{1u, 0.0f, 0.9}, {1u, 0.55f, 0.45 * 0.4 / 0.3025}, {64u, 1.0f, 0.45}, {64u, 7.0f, 0.45}}) {
        CAPTURE(group, asked);
        const std::vector<Cloth> cloths = every_kind_of_mesh();
        const Build build = with_stretches(group);
        Arrays arrays(cloths, Matrix::consistent, thirty_parts, 3);
        arrays.edit_states(
            [sub_steps = 31.0f * asked](apslk_solve_state& state) { state.asked_sub_steps = sub_steps; });
        const std::size_t run = arrays.adjacency.triangle_count;
        arrays.start_errors.write(std::vector<float>(arrays.start_errors.size(), 0.0f));
        arrays.vertex_bounds.write(std::vector<float>(arrays.vertex_bounds.size(), 1.0f));
        launch::assemble_gradients(arrays, build, 3, false);
        CHECK(arrays.start_errors.read() == std::vector<float>(arrays.start_errors.size(), 0.0f));
        const std::vector<float> plain = arrays.residual.read(), bounds = arrays.scaled_diagonal.read();
        // At the start 0.02, of which it is held what it may be.
        std::vector<float> held(3 * run, 0.0f);
        for (std::size_t c = 0; c < cloths.size(); ++c)
            for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a)
                held[APSLK_HELD_EXCESS * run + arrays.triangle_places[c][a]] = 0.01f * static_cast<float>(a % 5);
        std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(run), run, 0.02f);
        arrays.start_errors.write(held);
        launch::assemble_gradients(arrays, build, 3);
        const std::vector<float> next = arrays.start_errors.read(), residual = arrays.residual.read();
        const std::vector<Gradients> gradients = arrays.gradients.read();
        std::size_t at_work = 0, standing = 0;
        for (std::size_t c = 0; c < cloths.size(); ++c) {
            const BothRows both = both_rows(cloths[c]);
            for (std::size_t a = 0; a < cloths[c].rest_areas.size(); ++a) {
                if (cloths[c].stretch_ceilings[a] == 0.0) continue;
                CAPTURE(c, a);
                const std::size_t place = arrays.triangle_places[c][a];
                const double stands = static_cast<double>(held[APSLK_HELD_EXCESS * run + place]);
                const double excess = both.stretch[a] - cloths[c].stretch_ceilings[a];
                const double could_not = excess - excess_taken * (excess - stands) - asked_again / 30.0;
                const double want = std::max(std::exp(-7.0 / 30.0) * stands, std::min(could_not, 0.02));
                CHECK(static_cast<double>(next[APSLK_HELD_EXCESS * run + place]) ==
                      Approx(want).epsilon(1e-4).margin(1e-5));
                standing += want > std::exp(-7.0 / 30.0) * stands ? 1u : 0u;
                if (gradients[place].shift == 0.0f || both.weak[a] != 0) continue;
                ++at_work;
                const double scale = 1.0 / std::sqrt(static_cast<double>(bounds[run + place]));
                CHECK(static_cast<double>(residual[run + place]) ==
                      Approx(static_cast<double>(plain[run + place]) -
                             scale * excess_taken * cloths[c].rest_areas[a] * stands)
                          .epsilon(1e-3)
                          .margin(1e-5));
            }
        }
        CHECK(at_work > 50);
        CHECK(standing > 2);
    }
}

TEST_CASE("chebyshev_step with stretch rows: the clamped polynomial of the reference", "[chebyshev_step]") {
    for (const std::uint32_t group : {1u, 64u})
        for (const float alpha : {3.0f, 1.3f}) {
            CAPTURE(group, alpha);
            const std::vector<Cloth> cloths = every_kind_of_mesh();
            const Build build = with_stretches(group);
            Arrays arrays(cloths, Matrix::consistent, {.regularization = alpha, .sub_steps = 1}, 3);
            assemble(arrays, build);
            const int products = chebyshev_products(static_cast<double>(alpha), 50, true);
            for (int k = 0; k < products; ++k) launch::chebyshev_step(arrays, build, 0, products, k);
            const std::vector<float> pressures = arrays.pressure.read(), diagonal = arrays.scaled_diagonal.read();
            std::size_t clamped = 0, free = 0;
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                CAPTURE(c);
                const BothRows both = both_rows(cloths[c]);
                const std::size_t count = cloths[c].rest_areas.size();
                std::vector<double> bounds = arrays.of_cloth(diagonal, c);
                const std::vector<double> more = second_run_of_cloth(arrays, diagonal, c);
                bounds.insert(bounds.end(), more.begin(), more.end());
                // The device's own bounds: what differs there says nothing of this kernel.
                reference::TriangleVector<double> bound = both.bound;
                for (Eigen::Index r = 0; r < bound.size(); ++r)
                    if (both.system.scale[r] > 0.0)
                        bound[r] =
                            bounds[static_cast<std::size_t>(r)] / (2.0 * both.system.scale[r] * both.system.scale[r]);
                std::vector<std::uint8_t> one_sided(2 * count, 0);
                std::fill(one_sided.begin() + static_cast<std::ptrdiff_t>(count), one_sided.end(), std::uint8_t{1});
                reference::ChebyshevScratch<double> scratch;
                reference::TriangleVector<double> y;
                reference::chebyshev<double>(reference::row_matrix<double>(both.system, cloths[c].inverse_masses),
                                             bound, both.system.b, products, scratch, y, one_sided);
                std::vector<double> want, got = arrays.of_cloth(pressures, c);
                std::vector<double> stretches = second_run_of_cloth(arrays, pressures, c);
                got.insert(got.end(), stretches.begin(), stretches.end());
                for (Eigen::Index r = 0; r < y.size(); ++r)  // y over √D to λ, times √B to the stored multiplier
                    want.push_back(both.system.scale[r] > 0.0 ? y[r] * std::sqrt(bound[r] / 2.0) : 0.0);
                CHECK(difference(got, want) <= 2e-3 * products * norm(want));
                for (const double multiplier : stretches) {
                    CHECK(multiplier >= 0.0);
                    ++(multiplier > 0.0 ? free : clamped);
                }
            }
            CHECK(free > 20);
            CHECK(clamped > 20);
        }
}
