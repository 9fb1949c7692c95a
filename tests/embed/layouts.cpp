// SPDX-License-Identifier: MIT
//
// The caller's layouts: whatever lies where, the results are those of packed arrays, to the byte, and nothing else is
// written. The buffers here are sub-buffers, between guard bands.
#include "embed/variants.hpp"
#include "support/device_cloth.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;

namespace {

const std::vector<MovingCloth>& cloths() {
    static const std::vector<MovingCloth> made{moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1),
                                               moving_cloth(tetrahedron(), 2)};
    return made;
}
constexpr std::size_t vertex_count = 81 + 4;

std::vector<std::shared_ptr<const Topology>> topologies() {
    return {cloths()[0].topology, cloths()[1].topology};
}

/// Where positions, velocities and inverse masses lie in one buffer of `size` floats; offsets in floats.
struct Arrangement {
    const char* name;
    Options layout;
    std::size_t size, positions, velocities, inverse_masses;
};

const Arrangement arrangements[] = {
    {"xyz", {}, 600, 0, 255, 510},
    {"xyzw, the inverse mass in the positions' w",
     {.position_stride = 4, .velocity_stride = 4, .inverse_mass_stride = 4},
     680,
     0,
     340,
     3},
    {"a vertex of 12 floats: normal, position, inverse mass, velocity",
     {.position_stride = 12, .velocity_stride = 12, .inverse_mass_stride = 12},
     1020,
     3,
     7,
     6},
    {"a structure of arrays",
     {.position_stride = 1,
      .velocity_stride = 1,
      .position_component_stride = vertex_count,
      .velocity_component_stride = vertex_count},
     595,
     0,
     255,
     510},
    {"a structure of arrays with room for more vertices",
     {.position_stride = 1, .velocity_stride = 1, .position_component_stride = 100, .velocity_component_stride = 96},
     700,
     5,
     400,
     310},
    {"runs of pairs: position beside velocity",
     {.position_stride = 2,
      .velocity_stride = 2,
      .position_component_stride = 200,
      .velocity_component_stride = 200,
      .inverse_mass_stride = 2},
     800,
     0,
     1,
     600},
    {"positions in runs, velocities side by side",
     {.position_stride = 1, .velocity_stride = 5, .position_component_stride = 90},
     900,
     0,
     300,
     780},
};

/// `width` numbers a vertex, [width · V], to where the strides say.
void place(std::vector<float>& floats, const std::vector<float>& numbers, std::size_t width, std::size_t offset,
           std::size_t stride, std::size_t component_stride) {
    for (std::size_t n = 0; n < numbers.size(); ++n)
        floats.at(offset + n / width * stride + n % width * component_stride) = numbers[n];
}

void place_positions(std::vector<float>& floats, const Arrangement& a, const std::vector<float>& positions) {
    place(floats, positions, 3, a.positions, a.layout.position_stride, a.layout.position_component_stride);
}

void place_velocities(std::vector<float>& floats, const Arrangement& a, const std::vector<float>& velocities) {
    place(floats, velocities, 3, a.velocities, a.layout.velocity_stride, a.layout.velocity_component_stride);
}

std::vector<float> all(std::vector<double> MovingCloth::* numbers) {
    std::vector<float> out;
    for (const MovingCloth& cloth : cloths())
        for (const double number : cloth.*numbers) out.push_back(static_cast<float>(number));
    return out;
}

/// Poison wherever nothing lies.
std::vector<float> arranged(const Arrangement& a, bool with_velocities) {
    std::vector<float> floats = poison<float>(a.size);
    place_positions(floats, a, all(&MovingCloth::positions));
    if (with_velocities) place_velocities(floats, a, all(&MovingCloth::velocities));
    place(floats, all(&MovingCloth::inverse_masses), 1, a.inverse_masses, a.layout.inverse_mass_stride, 0);
    return floats;
}

Buffers views_of(const Arrangement& a, const DeviceArray<float>& vertices, const DeviceArray<float>& rest_areas,
                 bool positions_only) {
    return {.positions = {vertices.get(), 4 * a.positions},
            .velocities = positions_only ? BufferView{} : BufferView{vertices.get(), 4 * a.velocities},
            .inverse_masses = {vertices.get(), 4 * a.inverse_masses},
            .rest_areas = {rest_areas.get(), 0}};
}

std::vector<Stats> run(StrainLimiter& limiter, const Buffers& views, const Parameters& parameters) {
    const Owned<cl_command_queue> queue = in_order_queue();
    require_success(wait_and_release(limiter.enqueue(queue.get(), views, parameters)), "the filter");
    std::vector<Stats> stats(limiter.cloth_count());
    require_success(wait_and_release(limiter.read_stats(queue.get(), stats)), "the statistics");
    return stats;
}

/// 1 / Δt is a power of two: dividing by Δt rounds nothing.
constexpr Parameters whole_steps{
    .time_step = 1.0f / 64.0f, .regularization = 2.0f, .sub_steps = 4, .stepping = Stepping::whole_step};
/// 30 of them. α is what the printed matrix needs.
constexpr Parameters small_steps{.regularization = 2.0f};

}  // namespace

TEST_CASE("every layout gives the bytes of packed arrays", "[embed]") {
    for (const Options& variant : compared_variants()) {
        StrainLimiter packed_limiter(device().context, device().id, topologies(), variant);
        for (const Arrangement& a : arrangements) {
            CAPTURE(a.name, static_cast<int>(variant.apply), static_cast<int>(variant.execution));
            StrainLimiter limiter(device().context, device().id, topologies(), with_layout(variant, a.layout));
            for (const Parameters& parameters : {whole_steps, small_steps}) {
                const CallerBuffers packed(cloths(), variant);
                const std::vector<Stats> packed_stats = filter(packed_limiter, packed, {&parameters, 1});
                const std::vector<float> velocities = packed.read_velocities();
                REQUIRE_FALSE(same_bytes(velocities, all(&MovingCloth::velocities)));
                const DeviceArray<float> vertices(arranged(a, true)), rest_areas(all(&MovingCloth::rest_areas));
                const std::vector<Stats> stats = run(limiter, views_of(a, vertices, rest_areas, false), parameters);
                std::vector<float> expected = arranged(a, true);
                place_velocities(expected, a, velocities);
                CHECK(same_bytes(vertices.read(), expected));
                CHECK(same_bytes(stats, packed_stats));
            }
        }
    }
}

TEST_CASE("positions only: what the filter moves a cloth by that is at rest at the end of the step", "[embed]") {
    for (const Options& variant : compared_variants()) {
        std::vector<MovingCloth> resting = cloths();
        for (MovingCloth& cloth : resting) cloth.velocities.assign(cloth.velocities.size(), 0.0);
        const CallerBuffers packed(resting, variant);
        StrainLimiter packed_limiter(device().context, device().id, topologies(), variant);
        const std::vector<Stats> packed_stats = filter(packed_limiter, packed, {&whole_steps, 1});
        const std::vector<float> velocities = packed.read_velocities();
        REQUIRE(packed_stats[0].sub_steps == whole_steps.sub_steps);
        for (const Arrangement& a : {arrangements[0], arrangements[1], arrangements[4]}) {
            CAPTURE(a.name, static_cast<int>(variant.apply), static_cast<int>(variant.execution));
            Options options = with_layout(variant, a.layout);
            options.positions_only = true;
            StrainLimiter limiter(device().context, device().id, topologies(), options);
            const DeviceArray<float> vertices(arranged(a, false)), rest_areas(all(&MovingCloth::rest_areas));
            // The time step has no part in it.
            Parameters parameters = whole_steps;
            parameters.time_step = 0.3f;
            parameters.stepping = Stepping::automatic;
            const std::vector<Stats> stats = run(limiter, views_of(a, vertices, rest_areas, true), parameters);
            CHECK(same_bytes(stats, packed_stats));

            const std::vector<float> after = vertices.read(), given = all(&MovingCloth::positions),
                                     inverse_masses = all(&MovingCloth::inverse_masses);
            std::vector<float> got(given.size());
            for (std::size_t n = 0; n < got.size(); ++n)
                got[n] =
                    after[a.positions + n / 3 * a.layout.position_stride + n % 3 * a.layout.position_component_stride];
            std::size_t wrong = 0, moved = 0;
            for (std::size_t n = 0; n < got.size(); ++n) {
                wrong += (got[n] - given[n]) * 64.0f != velocities[n];
                moved += got[n] != given[n];
                if (inverse_masses[n / 3] == 0.0f) wrong += !same_bytes(std::vector{got[n]}, std::vector{given[n]});
            }
            CHECK(wrong == 0);
            CHECK(moved > got.size() / 2);
            std::vector<float> expected = arranged(a, false);
            place_positions(expected, a, got);
            CHECK(same_bytes(after, expected));
        }
    }
}

TEST_CASE("positions only: what is not finite is diverged and stays; 30 automatic sub-steps are whole", "[embed]") {
    for (const Execution execution : {Execution::many_groups, Execution::one_group}) {
        const Arrangement& a = arrangements[0];
        StrainLimiter limiter(device().context, device().id, topologies(),
                              {.execution = execution, .positions_only = true});
        const DeviceArray<float> rest_areas(all(&MovingCloth::rest_areas));
        std::vector<float> broken = arranged(a, false);
        broken[3 * 40] = std::numeric_limits<float>::quiet_NaN();
        const DeviceArray<float> vertices(broken);
        const std::vector<Stats> stats = run(limiter, views_of(a, vertices, rest_areas, true), {.sub_steps = 2});
        CHECK(stats[0].status == Status::diverged);
        CHECK(stats[0].offender == Offender::vertex);
        CHECK(stats[0].offender_index == 40);
        CHECK(stats[1].status != Status::diverged);
        const std::vector<float> after = vertices.read();
        CHECK(same_bytes(std::vector(after.begin(), after.begin() + 243),
                         std::vector(broken.begin(), broken.begin() + 243)));

        const DeviceArray<float> automatic(arranged(a, false)), whole(arranged(a, false));
        run(limiter, views_of(a, automatic, rest_areas, true), {.sub_steps = 30});
        run(limiter, views_of(a, whole, rest_areas, true), {.sub_steps = 30, .stepping = Stepping::whole_step});
        CHECK(same_bytes(automatic.read(), whole.read()));
    }
}
