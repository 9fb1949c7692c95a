// SPDX-License-Identifier: MIT
#include "reference/effective_masses.hpp"

#include "kernels/launch.hpp"
#include "reference/displacements.hpp"
#include "support/tolerances.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <utility>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Parameters walk{.regularization = 1.2f, .sub_steps = 21, .stepping = Stepping::small_steps};
// Among the stiffnesses that the pressures below come to.
constexpr float greatest_mass = 0.5f;

// Masses that rose before by different factors, and the stiffness that each vertex keeps: by the caller's vertices.
struct Before {
    std::vector<double> given, effective, kept;
};

Before prepare(Arrays& arrays) {
    arrays.edit_states([](apsl_solve_state& state) {
        state.solve_iterations = 3;
        state.greatest_mass = greatest_mass;
    });
    // Mostly tension, of sizes that leave some vertices as they are, raise some and meet the greatest mass with others.
    arrays.pressure.write(arrays.over_triangles([](std::size_t c, std::size_t a) {
        return 0.02 * std::exp(3.0 * std::sin(2.3 * static_cast<double>(a) + static_cast<double>(c))) - 0.01;
    }));
    const std::size_t count = arrays.predicted.size();
    std::vector<cl_float4> motion = arrays.predicted.read(), correction(count), predicted = motion;
    for (cl_float4& step : motion) step = {{0.5f, -0.25f, 1.0f, step.s[3]}};
    Before before{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count)};
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t place = arrays.vertex_places[i];
        if (i % 3 == 0) predicted[place].s[3] *= 0.25f;
        const float kept = i % 4 == 0 ? 0.2f * static_cast<float>(i % 5) : 0.0f;
        correction[place] = {{0.0f, 0.0f, 0.0f, kept}};
        before.given[i] = motion[place].s[3];
        before.effective[i] = predicted[place].s[3];
        before.kept[i] = kept;
    }
    arrays.motion.write(motion);
    arrays.correction.write(correction);
    arrays.predicted.write(predicted);
    return before;
}

// λ of the stored y: the arrays' gradients are those of the given masses, √(w/2) g / √(α D), and the kernel takes them
// for those of the effective ones. What it sees are the triangles' own gradients times √(w/w').
std::vector<double> pressures(const Arrays& arrays, std::size_t c) {
    std::vector<double> lambda = arrays.of_cloth(arrays.pressure.read(), c);
    for (std::size_t a = 0; a < lambda.size(); ++a) lambda[a] *= arrays.solves[c].scale[a];
    return lambda;
}

template <class Range>
std::vector<double> part(const Range& all, std::size_t first, std::size_t count) {
    return {all.begin() + static_cast<std::ptrdiff_t>(first), all.begin() + static_cast<std::ptrdiff_t>(first + count)};
}

void check_walked(const std::vector<Cloth>& cloths, std::uint32_t group, bool last) {
    CAPTURE(group, last);
    Arrays arrays(cloths, Matrix::consistent, walk, 3);
    const Before before = prepare(arrays);
    const std::vector<cl_float4> start = arrays.predicted.read();
    const int sub_step = last ? 20 : 7;
    launch::gather_displacements(arrays, {.work_group_size = group}, 0, sub_step);
    const std::vector<cl_float4> after = arrays.predicted.read(), correction = arrays.correction.read(),
                                 motion = arrays.motion.read();
    std::size_t first = 0, raised = 0, capped = 0, held = 0, as_given = 0;
    for (std::size_t c = 0; c < cloths.size(); ++c) {
        CAPTURE(c);
        const Topology& topology = *cloths[c].topology;
        const std::size_t count = topology.vertex_count();
        const std::vector<double> given = part(before.given, first, count);
        reference::EffectiveMasses<double> masses;
        masses.start(given);
        masses.greatest = static_cast<double>(greatest_mass);
        masses.inverse = part(before.effective, first, count);
        masses.stiffness = part(before.kept, first, count);
        masses.find_tension(topology, arrays.solves[c].geometry, pressures(arrays, c));
        std::vector<double> moves;
        reference::displacements<double>(topology, arrays.solves[c].geometry, given, pressures(arrays, c), moves);
        std::vector<double> errors, sizes;
        for (std::size_t v = 0; v < count; ++v) {
            const std::uint32_t place = arrays.vertex_places[first + v];
            CAPTURE(v);
            CHECK(motion[place].s[3] == static_cast<float>(given[v]));
            if (given[v] == 0.0) {
                CHECK(after[place].s[3] == 0.0f);
                for (int k = 0; k < 3; ++k) CHECK(correction[place].s[k] == 0.0f);
                continue;
            }
            // The kernel's √(2 w') ḡ is √(w'/w) √(2 w) ḡ, and its |ḡ|²/w' is w/w' |ḡ|²/w.
            masses.tension[v] *= given[v] / masses.inverse[v];
            const double taken = masses.share_taken(v, given[v]);
            held += taken < 1.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const double change = taken * std::sqrt(masses.inverse[v] / given[v]) * moves[3 * v + k];
                const double carried = last ? 1.0 : 13.0;  // 20 parts, of which 7 are gone
                errors.push_back(static_cast<double>(correction[place].s[k]) - carried * change);
                const double step = last ? 0.0 : (std::array{0.5, -0.25, 1.0}[k] + 20.0 * change) / 20.0;
                errors.push_back(static_cast<double>(after[place].s[k]) -
                                 (static_cast<double>(start[place].s[k]) + change + step));
                sizes.push_back(std::abs(cloths[c].positions[3 * v + k]) + carried * std::abs(change) + 1.0);
            }
        }
        CHECK(norm(errors) <= (elementwise_tolerance(20) + 4.0 * gradient_unit) * norm(sizes));
        const std::vector<double> kept = masses.stiffness;
        masses.raise(given);
        for (std::size_t v = 0; v < count; ++v) {
            const std::uint32_t place = arrays.vertex_places[first + v];
            if (given[v] == 0.0) continue;
            CAPTURE(v, given[v], masses.stiffness[v]);
            if (last) {  // no sub-step follows: nothing is renewed
                CHECK(after[place].s[3] == static_cast<float>(before.effective[first + v]));
                CHECK(static_cast<double>(correction[place].s[3]) == kept[v]);
                continue;
            }
            CHECK(static_cast<double>(correction[place].s[3]) ==
                  Approx(masses.stiffness[v]).epsilon(2e-3).margin(1e-6));
            const double ratio = static_cast<double>(after[place].s[3]) / masses.inverse[v];
            CHECK(ratio == Approx(1.0).epsilon(2e-3));
            raised += masses.inverse[v] < given[v];
            capped += masses.inverse[v] < given[v] && 1.0 / masses.inverse[v] == masses.greatest;
            const bool by_far = 2.0 * masses.stiffness[v] * given[v] < 0.99;
            as_given += by_far;
            if (by_far) CHECK(after[place].s[3] == static_cast<float>(given[v]));
        }
        first += count;
    }
    // Each of these happens.
    CHECK(held > 0);
    if (last) return;
    CHECK(raised > 0);
    CHECK(capped > 0);
    CHECK(as_given > 0);
}

}  // namespace

TEST_CASE("gather_displacements: effective masses as the reference finds them", "[gather_displacements]") {
    const std::vector<Cloth> cloths{make_cloth(grid(9, 11, 1.0, 1.0, Diagonals::alternating), 1),
                                    make_cloth(strip(300), 2), make_cloth(fan(30), 3)};
    for (const std::uint32_t group : work_group_sizes())
        for (const bool last : {false, true}) check_walked(cloths, group, last);
}

TEST_CASE("gather_displacements: masses stay as they are with fewer than 20 sub-steps", "[gather_displacements]") {
    const std::vector<Cloth> cloths{make_cloth(strip(300), 2)};
    Parameters few = walk;
    few.sub_steps = 19;
    Arrays arrays(cloths, Matrix::consistent, few, 3);
    prepare(arrays);
    const std::vector<cl_float4> before = arrays.predicted.read(), kept = arrays.correction.read();
    launch::gather_displacements(arrays, {}, 0, 7);
    const std::vector<cl_float4> after = arrays.predicted.read(), correction = arrays.correction.read();
    for (std::size_t place = 0; place < before.size(); ++place) {
        CHECK(after[place].s[3] == before[place].s[3]);
        CHECK(correction[place].s[3] == kept[place].s[3]);
    }
}

TEST_CASE("gather_displacements: compression and triangles without area stiffen nothing", "[gather_displacements]") {
    std::vector<Cloth> cloths{make_cloth(strip(9), 1)};
    for (std::size_t k = 0; k < 3; ++k) cloths[0].positions[3 + k] = cloths[0].positions[k];  // triangle 0 has no area
    for (const bool pressed : {false, true}) {
        CAPTURE(pressed);
        Arrays arrays(cloths, Matrix::consistent, walk, 1);
        prepare(arrays);
        arrays.correction.write(std::vector<cl_float4>(arrays.correction.size(), cl_float4{{0.0f, 0.0f, 0.0f, 0.0f}}));
        launch::assemble_gradients(arrays, {});
        arrays.pressure.write(arrays.over_triangles([&](std::size_t, std::size_t a) {
            return pressed ? -1.0 : a == 0 ? 1.0 : 0.0;
        }));
        launch::gather_displacements(arrays, {}, 0, 7);
        for (const cl_float4& correction : arrays.correction.read()) CHECK(correction.s[3] == 0.0f);
    }
}

TEST_CASE("measure_area_change: vertices that weigh more than given, and how much more", "[measure_area_change]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const bool raises_masses : {false, true}) {
            CAPTURE(group, raises_masses);
            const std::vector<Cloth> cloths{make_cloth(strip(300), 1), make_cloth(strip(5), 2)};
            Parameters parameters = walk;
            if (!raises_masses) parameters.sub_steps = 19;
            Arrays arrays(cloths, Matrix::consistent, parameters, 3);
            std::vector<cl_float4> predicted = arrays.predicted.read();
            arrays.motion.write(predicted);
            std::size_t count = 0;
            for (std::size_t i = 0; i < 302; i += 5) {
                float& w = predicted[arrays.vertex_places[i]].s[3];
                count += w > 0.0f;
                w *= i == 100 ? 0.0625f : 0.5f;
            }
            REQUIRE(predicted[arrays.vertex_places[100]].s[3] > 0.0f);
            arrays.predicted.write(predicted);
            arrays.partials.write(poison<float>(arrays.partials.size()));
            launch::measure_area_change(arrays, {.work_group_size = group});
            const auto in_all = [&](std::size_t c, int kind) { return arrays.partials_of(c, kind); };
            const std::vector<double> counts = in_all(0, APSL_PARTIAL_RAISED),
                                      ratios = in_all(0, APSL_PARTIAL_MASS_RATIO);
            CHECK(std::accumulate(counts.begin(), counts.end(), 0.0) ==
                  (raises_masses ? static_cast<double>(count) : 0.0));
            CHECK(*std::max_element(ratios.begin(), ratios.end()) == (raises_masses ? 16.0 : 1.0));
            for (std::uint32_t g = 0; g < arrays.groups; ++g) {
                CHECK(in_all(1, APSL_PARTIAL_RAISED)[g] == 0.0);
                CHECK(in_all(1, APSL_PARTIAL_MASS_RATIO)[g] == 1.0);
            }
        }
}
