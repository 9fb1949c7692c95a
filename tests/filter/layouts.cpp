// SPDX-License-Identifier: MIT
//
// Layouts, a cloth that is off and scratch memory of the caller's, all at once and in small steps, against the
// reference. That each alone changes no byte: tests/embed/layouts.cpp and changes.cpp.
#include "filter/filtered.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl;
using namespace apsl::test;

namespace {

/// x̃ and ṽ in runs of their own, with room for more vertices; and xyzw with the masses in another buffer.
constexpr Options layouts[] = {
    {.position_stride = 1, .velocity_stride = 1, .position_component_stride = 700, .velocity_component_stride = 650},
    {.position_stride = 4, .velocity_stride = 5, .inverse_mass_stride = 2}};

Owned<cl_mem> poisoned_buffer(std::size_t bytes) {
    std::vector<unsigned char> contents = poison<unsigned char>(bytes);
    cl_int status = CL_SUCCESS;
    const cl_mem buffer =
        clCreateBuffer(device().context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes, contents.data(), &status);
    require_success(status, "clCreateBuffer");
    return {buffer, clReleaseMemObject};
}

}  // namespace

TEST_CASE("the filter agrees with the reference in small steps: layouts, a cloth off, the caller's scratch memory",
          "[filter]") {
    std::vector<MovingCloth> cloths{moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1),
                                    moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::uniform), 2),
                                    moving_cloth(grid(21, 9, 2.0, 1.0, Diagonals::random), 3)};
    cloths[1].velocities[7] = std::numeric_limits<double>::quiet_NaN();  // nobody looks at it
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const MovingCloth& cloth : cloths) topologies.push_back(cloth.topology);
    Stats off{};
    off.status = Status::off;
    // 20 sub-steps are small of themselves.
    for (const std::int32_t sub_steps : {4, 20}) {
        std::vector<Parameters> parameters(3,
                                           {.regularization = 1.3f,
                                            .sub_steps = sub_steps,
                                            .tolerance = 1e-4f,
                                            .max_iterations = 100,
                                            .stepping = sub_steps < 20 ? Stepping::small_steps : Stepping::automatic});
        parameters[1].enabled = false;
        for (const Options& variant : {variants[0], many_groups, one_group})
            for (const std::uint32_t work_group_size : compared_group_sizes())
                for (const Options& layout : layouts) {
                    Options options = with_layout(variant, layout);
                    options.work_group_size = work_group_size;
                    CAPTURE(variant_name(options), options.position_stride, sub_steps);
                    const Owned<cl_mem> scratch =
                        poisoned_buffer(StrainLimiter::required_scratch_bytes(device().id, topologies, options));
                    StrainLimiter limiter(device().context, device().id, topologies, options, {}, {scratch.get(), 0});
                    const CallerBuffers buffers(cloths, options, 3);
                    const std::vector<Stats> stats = filter(limiter, buffers, parameters);
                    const std::vector<float> velocities = buffers.read_velocities();
                    auto begin = velocities.begin();
                    for (std::size_t c = 0; c < cloths.size(); ++c) {
                        CAPTURE(c);
                        const auto end = begin + static_cast<std::ptrdiff_t>(cloths[c].velocities.size());
                        if (parameters[c].enabled) {
                            check_against_reference({{begin, end}, stats[c]}, cloths[c], options, parameters[c]);
                        } else {
                            CHECK(same_bytes(std::vector(begin, end), std::vector<float>(cloths[c].velocities.begin(),
                                                                                         cloths[c].velocities.end())));
                            CHECK(same_bytes(std::vector{stats[c]}, std::vector{off}));
                            CHECK(
                                same_bytes(std::vector{filter_with_reference(cloths[c], options, parameters[c]).stats},
                                           std::vector{stats[c]}));
                        }
                        begin = end;
                    }
                }
    }
}
