// SPDX-License-Identifier: MIT
#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

using namespace apsl;
using namespace apsl::test;

namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double partial_sum(const Arrays& arrays, std::size_t cloth, int kind) {
    const std::vector<double> parts = arrays.partials_of(cloth, kind);
    return std::accumulate(parts.begin(), parts.end(), 0.0);
}

// A guess and its product with the matrix, both near r.
void write_guess(Arrays& arrays, const std::vector<std::vector<double>>& r) {
    arrays.pressure.write(arrays.over_triangles(
        [&](std::size_t c, std::size_t a) { return 3.0 * r[c][a] * (1.0 + 0.3 * std::sin(static_cast<double>(a))); }));
    arrays.product.write(arrays.over_triangles(
        [&](std::size_t c, std::size_t a) { return 5.0 * r[c][a] * (1.0 + 0.2 * std::cos(static_cast<double>(a))); }));
}

}  // namespace

TEST_CASE("warm_start: scaled to the solution's size, awkward sizes in every work-group size",
          "[measure_guess][start_from_guess]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const std::uint32_t size : awkward_sizes(group)) {
            CAPTURE(group, size);
            const Build build{.work_group_size = group};
            const std::vector<Cloth> cloths{make_cloth(strip(size), 1), make_cloth(strip(5), 2)};
            Arrays arrays(cloths, Matrix::consistent, paper_setting, 3);
            std::vector<std::vector<double>> r;
            for (std::size_t c = 0; c < 2; ++c) r.push_back(arrays.of_cloth(arrays.residual.read(), c));
            write_guess(arrays, r);
            const std::vector<float> guesses = arrays.pressure.read(), products = arrays.product.read();

            launch::measure_guess(arrays, build);
            for (std::size_t c = 0; c < 2; ++c) {
                const double expected = dot(r[c], arrays.of_cloth(guesses, c));
                CHECK(std::abs(partial_sum(arrays, c, APSLK_PARTIAL_GUESS) - expected) <=
                      sum_tolerance(2, r[c].size()) * expected);
                arrays.write_partial_sum(c, APSLK_PARTIAL_CURVATURE, 1.7 * expected);
            }
            launch::start_from_guess(arrays, build);
            for (std::size_t c = 0; c < 2; ++c) {
                const double scale = 1.0 / 1.7;
                const std::vector<double> q = arrays.of_cloth(products, c);
                std::vector<double> y = arrays.of_cloth(guesses, c), left = r[c];
                for (std::size_t a = 0; a < left.size(); ++a) {
                    y[a] *= scale;
                    left[a] -= scale * q[a];
                }
                // The dot product's rounding goes into the scale.
                const double off = sum_tolerance(8, left.size()) * (norm(r[c]) + scale * norm(q));
                CHECK(difference(arrays.of_cloth(arrays.pressure.read(), c), y) <=
                      sum_tolerance(8, left.size()) * norm(y));
                CHECK(difference(arrays.of_cloth(arrays.residual.read(), c), left) <= off);
                CHECK(std::abs(std::sqrt(partial_sum(arrays, c, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN)) - norm(left)) <=
                      2.0 * off);
                const double plain = std::sqrt(arrays.unscaled_squared(c, left));
                CHECK(std::abs(std::sqrt(partial_sum(arrays, c, APSLK_PARTIAL_RESIDUAL_EVEN)) - plain) <=
                      2.0 * off * plain / norm(left));
            }
            for (const float number : arrays.padding_of(arrays.pressure.read())) CHECK(number == 0.0f);
        }
}

TEST_CASE("warm_start: one that is no use is dropped, and a stopped cloth's is kept",
          "[measure_guess][start_from_guess]") {
    const std::vector<Cloth> cloths{make_cloth(strip(50), 1)};
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [guess, curvature] :
         {std::pair{nan, 1.0}, std::pair{1.0, 0.0}, std::pair{1.0, -1.0}, std::pair{1.0, nan}, std::pair{0.0, 0.0}}) {
        CAPTURE(guess, curvature);
        Arrays arrays(cloths, Matrix::consistent, paper_setting, 2);
        arrays.pressure.write(arrays.over_triangles([value = guess](std::size_t, std::size_t) { return value; }));
        arrays.product.write(arrays.over_triangles([](std::size_t, std::size_t) { return nan; }));
        const std::vector<float> before = arrays.residual.read();
        launch::measure_guess(arrays, {});
        arrays.write_partial_sum(0, APSLK_PARTIAL_CURVATURE, curvature);
        launch::start_from_guess(arrays, {});
        CHECK(same_bytes(arrays.residual.read(), before));
        for (const double y : arrays.of_cloth(arrays.pressure.read(), 0)) CHECK(y == 0.0);
        const double expected = norm(arrays.of_cloth(before, 0));
        CHECK(std::abs(std::sqrt(partial_sum(arrays, 0, APSLK_PARTIAL_SCALED_RESIDUAL_EVEN)) - expected) <=
              sum_tolerance(2, 50) * expected);
    }
    Arrays arrays(cloths, Matrix::consistent, paper_setting, 2);
    write_guess(arrays, {arrays.of_cloth(arrays.residual.read(), 0)});
    arrays.edit_states([](apslk_solve_state& state) { state.stopped = 1; });
    arrays.write_partial_sum(0, APSLK_PARTIAL_CURVATURE, 1.0);
    const std::vector<float> guess = arrays.pressure.read(), residual = arrays.residual.read();
    launch::measure_guess(arrays, {});
    launch::start_from_guess(arrays, {});
    CHECK(same_bytes(arrays.pressure.read(), guess));
    CHECK(same_bytes(arrays.residual.read(), residual));
}
