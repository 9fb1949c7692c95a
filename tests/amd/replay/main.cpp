// SPDX-License-Identifier: MIT
// Runs one scenario of scenarios.cpp, under the recorder. Without a name prints the names of the small ones, with
// --further those of the others.
#include "amd/replay/scenarios.hpp"

#include <algorithm>
#include <exception>
#include <iostream>
#include <string_view>

namespace {

using namespace apsl;
using namespace apsl::test;

Buffers views_of(const CallerBuffers& buffers) {
    Buffers views = buffers.views();
    if (buffers.options.positions_only) views.velocities = {};
    return views;
}

void run(const Scenario& scenario) {
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const MovingCloth& cloth : scenario.cloths) topologies.push_back(cloth.topology);
    StrainLimiter limiter(device().context, device().id, topologies, scenario.options);
    const CallerBuffers buffers(scenario.cloths, scenario.options);
    const Buffers views = views_of(buffers);
    const Owned<cl_command_queue> queue = in_order_queue();

    // What rest positions give is compared with what the caller gives, but not taken for it: a cloth in motion is none
    // at rest.
    const DeviceArray<float> areas(poison<float>(buffers.rest_areas.size()));
    const DeviceArray<float> shapes(poison<float>(buffers.rest_shapes.size()));
    wait_and_release(limiter.enqueue_rest_areas(queue.get(), views.positions, {areas.get()}));
    if (scenario.options.limits_stretch)
        wait_and_release(limiter.enqueue_rest_shapes(queue.get(), views.positions, {shapes.get()}));
    const DeviceArray<float> hinges(poison<float>(buffers.rest_hinges.size()));
    if (scenario.options.bends)
        wait_and_release(limiter.enqueue_rest_hinges(queue.get(), views.positions, {hinges.get()}));

    std::vector<Stats> stats(limiter.cloth_count());
    for (int call = 0; call < scenario.calls; ++call) {
        const cl_event limited = limiter.enqueue(queue.get(), views, scenario.parameters);
        require_success(wait_and_release(limiter.read_stats(queue.get(), stats, {&limited, 1})), "the call");
        clReleaseEvent(limited);
        for (const Stats& of : stats)
            std::cout << scenario.name << ": status " << static_cast<int>(of.status) << ", sub_steps " << of.sub_steps
                      << ", iterations " << of.iterations << ", area change " << of.initial_max_area_change << " -> "
                      << of.max_area_change << ", stretch rows " << of.stretch_rows << '\n';
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string_view wanted = argc > 1 ? argv[1] : "";
        std::vector<Scenario> scenarios = wanted == "--further" ? further_scenarios() : small_scenarios();
        if (wanted.empty() || wanted == "--further") {
            for (const Scenario& scenario : scenarios) std::cout << scenario.name << '\n';
            return 0;
        }
        for (Scenario& scenario : further_scenarios()) scenarios.push_back(std::move(scenario));
        const auto found = std::ranges::find(scenarios, wanted, &Scenario::name);
        if (found == scenarios.end()) {
            std::cerr << "no scenario " << wanted << '\n';
            return 2;
        }
        run(*found);
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
