// SPDX-License-Identifier: MIT
#include "reference/contact.hpp"

#include "kernels/launch.hpp"
#include "support/tolerances.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

using Vector = reference::Vector3<double>;

constexpr Parameters small_steps{.regularization = 1.2f, .sub_steps = 5, .stepping = Stepping::small_steps};
constexpr double parts = 4.0;

Vector vector_of(const cl_float4& v) {
    return Vector(static_cast<double>(v.s[0]), static_cast<double>(v.s[1]), static_cast<double>(v.s[2]));
}

// Three numbers of vertex v.
Vector vector_of(const std::vector<float>& numbers, std::size_t v) {
    return Vector(static_cast<double>(numbers[3 * v]), static_cast<double>(numbers[3 * v + 1]),
                  static_cast<double>(numbers[3 * v + 2]));
}

// The end of a whole step of vertex v that nothing limits, kept outside.
struct FreeEnd {
    reference::MovingVertex<double> at;
    bool touches;
};

FreeEnd free_end(const Cloth& cloth, std::size_t v) {
    const auto time_step = static_cast<double>(small_steps.time_step);
    const Vector start = reference::position<double>(cloth.positions, v),
                 motion = time_step * reference::position<double>(cloth.velocities, v);
    FreeEnd end{{start + motion, motion, motion}, false};
    if (cloth.inverse_masses[v] > 0.0)
        end.touches = end.at.keep(reference::Contact<double>(cloth.contacts, v), time_step, 0.0, 1.0);
    return end;
}

// Of free vertices what a launch left and what the reference makes of it, with the sizes that round.
struct Compared {
    std::vector<double> errors, sizes;

    void add(const Vector& got, const Vector& want, double size) {
        for (Eigen::Index k = 0; k < 3; ++k) {
            errors.push_back(got[k] - want[k]);
            sizes.push_back(size);
        }
    }
};

}  // namespace

TEST_CASE("contact in predict_positions: the end of the step is outside", "[predict_positions][contact]") {
    for (const std::uint32_t group : work_group_sizes()) {
        const std::vector<Cloth> cloths{make_cloth(strip(131), 1), make_cloth(strip(7), 2)};
        Arrays arrays(cloths, Matrix::consistent, small_steps, 3);
        launch::predict_positions(arrays, {.work_group_size = group, .keeps_contacts = true});
        const std::vector<cl_float4> moved = arrays.moved.read();
        Compared compared;
        std::size_t i = 0, touched = 0;
        for (const Cloth& cloth : cloths)
            for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v, ++i) {
                const FreeEnd end = free_end(cloth, v);
                touched += end.touches;
                compared.add(vector_of(moved[arrays.vertex_places[i]]), end.at.position,
                             reference::position<double>(cloth.positions, v).norm() + 1.0);
            }
        CHECK(touched > i / 4);
        CHECK(norm(compared.errors) <= elementwise_tolerance(12) * norm(compared.sizes));
    }
}

TEST_CASE("contact in gather_displacements: in every part, positions, motions and what they add to the step's end",
          "[gather_displacements][contact]") {
    const std::vector<Cloth> cloths{make_cloth(strip(300), 1)};
    const Cloth& cloth = cloths[0];
    const auto time_step = static_cast<double>(small_steps.time_step);
    for (const std::uint32_t group : work_group_sizes())
        // The last only mends positions.
        for (const auto& [sub_step, parts_left] : {std::pair{1, 2.0}, std::pair{3, 0.0}, std::pair{4, 0.0}}) {
            CAPTURE(group, sub_step);
            Arrays arrays(cloths, Matrix::consistent, small_steps, 3);
            arrays.edit_states([](apslk_solve_state& state) { state.solve_iterations = 0; });  // nothing was solved
            const std::vector<cl_float4> before = arrays.moved.read();
            std::vector<cl_float4> steps(before.size());
            const std::vector<double> numbers = random_numbers(3 * before.size(), -0.05, 0.05, 8);
            for (std::size_t i = 0; i < before.size(); ++i)
                for (std::size_t k = 0; k < 3; ++k) steps[i].s[k] = static_cast<float>(numbers[3 * i + k]);
            for (std::size_t i = 0; i < before.size(); ++i) steps[i].s[3] = before[i].s[3];
            arrays.motion.write(steps);
            arrays.total_correction.write(std::vector<cl_float4>(before.size(), cl_float4{{0.0f, 0.0f, 0.0f, 0.0f}}));
            launch::gather_displacements(arrays, {.work_group_size = group, .keeps_contacts = true}, 0, sub_step);
            const std::vector<cl_float4> after = arrays.moved.read(), motion = arrays.motion.read(),
                                         total = arrays.total_correction.read();
            Compared compared;
            std::size_t touched = 0;
            for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
                const std::size_t i = arrays.vertex_places[v];
                const Vector start = vector_of(before[i]), step = vector_of(steps[i]);
                const bool mends = sub_step == 4, pinned = cloth.inverse_masses[v] == 0.0;
                const reference::Contact<double> contact(cloth.contacts, v);
                const Vector now = mends ? Vector(time_step * contact.velocity) : step;
                reference::MovingVertex<double> end{start, now, now / parts};
                if (!pinned) touched += end.keep(contact, time_step, time_step * parts_left / parts, 1.0 / parts);
                const Vector want_motion = mends ? step : end.motion;
                const Vector onward = parts_left > 0.0 ? Vector(want_motion / parts) : Vector(Vector::Zero());
                const double size = start.norm() + 1.0;
                compared.add(vector_of(after[i]), end.position + onward, size);
                if (pinned) continue;
                compared.add(vector_of(motion[i]), want_motion, size);
                compared.add(vector_of(total[i]), end.position - start + (end.motion - now) * (parts_left / parts),
                             size);
            }
            CHECK(touched > cloth.inverse_masses.size() / 4);
            CHECK(norm(compared.errors) <= elementwise_tolerance(12) * norm(compared.sizes));
        }
}

TEST_CASE("contact in update_velocities: a call that was thrown away still leads outside, a diverged one not",
          "[update_velocities][contact]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 1)};
    const Cloth& cloth = cloths[0];
    const auto time_step = static_cast<double>(small_steps.time_step);
    Arrays arrays(cloths, Matrix::consistent, small_steps, 3);
    const std::vector<float> before = arrays.caller_velocities.read();
    arrays.edit_states([](apslk_solve_state& state) { state.discarded = 1; });
    std::vector<apslk_stats> stats = arrays.stats.read();
    stats[0].status = APSLK_STATUS_DIVERGED;
    arrays.stats.write(stats);
    launch::update_velocities(arrays, {.keeps_contacts = true});
    CHECK(same_bytes(before, arrays.caller_velocities.read()));

    stats[0].status = APSLK_STATUS_WORSENED;
    arrays.stats.write(stats);
    launch::update_velocities(arrays, {.keeps_contacts = true});
    const std::vector<float> after = arrays.caller_velocities.read();
    Compared compared;
    std::size_t touched = 0;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        const FreeEnd end = free_end(cloth, v);
        touched += end.touches;
        if (!end.touches) {
            for (std::size_t k = 3 * v; k < 3 * v + 3; ++k) CHECK(after[k] == before[k]);
            continue;
        }
        const Vector start = reference::position<double>(cloth.positions, v);
        compared.add(vector_of(after, v), (end.at.position - start) / time_step, (start.norm() + 1.0) / time_step);
    }
    CHECK(touched > cloth.inverse_masses.size() / 4);
    CHECK(norm(compared.errors) <= elementwise_tolerance(12) * norm(compared.sizes));
}

TEST_CASE("contact in store_step: a discarded step ends outside, with no speed into what it touches",
          "[store_step][contact]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 1)};
    const Cloth& cloth = cloths[0];
    const auto time_step = static_cast<double>(small_steps.time_step);
    Arrays arrays(cloths, Matrix::consistent, small_steps, 3);
    std::vector<cl_float4> motion = arrays.motion.read();
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
        motion[arrays.vertex_places[v]].s[3] = static_cast<float>(cloth.inverse_masses[v]);
    arrays.motion.write(motion);
    arrays.edit_states([](apslk_solve_state& state) { state.discarded = 1; });
    launch::store_step(arrays, {.integrates = true, .keeps_contacts = true});
    const std::vector<float> x = arrays.caller_positions.read(), u = arrays.caller_velocities.read();
    Compared compared;
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        const FreeEnd end = free_end(cloth, v);
        const double size = reference::position<double>(cloth.positions, v).norm() + 1.0;
        compared.add(vector_of(x, v), end.at.position, size);
        compared.add(time_step * vector_of(u, v), end.at.motion, size);
    }
    CHECK(norm(compared.errors) <= elementwise_tolerance(12) * norm(compared.sizes));
}
