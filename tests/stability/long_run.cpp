// SPDX-License-Identifier: MIT
//
// A scene run for very many frames: does anything drift? Energy, area change and memory of stretches of frames go into
// a JSON file; exit 1 where one of them grows after the cloth has settled, or where a number is not finite.
//
//   apsl_long_run SCENE FRAMES OUT.json [path=value]...
#include "stability/drift.hpp"
#include "stability/energy.hpp"
#include "support/resident_memory.hpp"

#include "run/input_error.hpp"
#include "run/parse_scene.hpp"
#include "run/progress.hpp"
#include "run/scene_springs.hpp"
#include "run/simulation.hpp"
#include "run/whole_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>

using namespace apsl;
using namespace apsl::scenes;
using namespace apsl::test;

namespace {

constexpr int stretch_count = 200;
constexpr int settling_stretches = 60;

int positive_number(const std::string& text) {
    std::size_t end = 0;
    int number = 0;
    try {
        number = std::stoi(text, &end);
    } catch (const std::exception&) {
        end = 0;
    }
    if (end != text.size() || number < stretch_count || number % stretch_count != 0)
        throw InputError("FRAMES is " + text + ", expected a multiple of " + std::to_string(stretch_count));
    return number;
}

/// A ten-thousandth of what the cloth could gain by falling as far as it is tall; area change by a tenth of the settled
/// one; 4 MiB, a few pages of the driver's: 40 bytes a frame of a run of 100,000.
DriftLimits limits_of(const ClothState& cloth, const std::array<double, 3>& gravity, double settled_area_change) {
    const double weight =
        std::accumulate(cloth.masses.begin(), cloth.masses.end(), 0.0) * std::hypot(gravity[0], gravity[1], gravity[2]);
    const double area = std::accumulate(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0);
    return {.energy = 1e-4 * weight * std::sqrt(area),
            .area_change = 0.1 * settled_area_change,
            .bytes = std::size_t{4} << 20};
}

nlohmann::ordered_json to_json(const Stretch& stretch) {
    return {{"last_frame", stretch.last_frame},           {"kinetic_energy", stretch.kinetic_energy},
            {"total_energy", stretch.total_energy},       {"max_area_change", stretch.max_area_change},
            {"rms_area_change", stretch.rms_area_change}, {"resident_bytes", stretch.resident_bytes}};
}

std::size_t device_bytes(Simulation& simulation) {
    const OpenClCloth* device = on_device(simulation.filter());
    return device ? device->device_bytes() : 0;
}

int run(const std::string& scene_file, int frames, const std::string& out, const std::vector<std::string>& changes) {
    const Scene scene = read_scene(scene_file, changes);
    SceneCloth cloth = make_scene_cloth(scene);
    const std::vector<Spring> springs = make_scene_springs(scene, cloth.state).springs;
    const OpenClDevice device = choose_opencl_device(std::nullopt);
    FilterStage filter = make_filter_stage(scene, cloth.state, Backend::opencl, device, false);
    Simulation simulation(scene, std::move(cloth), std::move(filter), false);
    const std::size_t bytes_before = device_bytes(simulation);

    std::vector<Stretch> stretches;
    std::vector<std::string> failures;
    int frames_not_ok = 0;
    const int length = frames / stretch_count;
    Progress progress(frames);
    for (int frame = 0; frame < frames && !simulation.breakdown(); ++frame) {
        if (frame % length == 0) stretches.emplace_back();
        Stretch& stretch = stretches.back();
        const FrameReport report = simulation.run_frame();
        const double kinetic = kinetic_energy(simulation.cloth());
        stretch.last_frame = frame;
        stretch.kinetic_energy += kinetic / length;
        stretch.total_energy += (kinetic + potential_energy(simulation.cloth(), springs, scene.gravity)) / length;
        stretch.max_area_change = std::max(stretch.max_area_change, report.max_area_change);
        stretch.rms_area_change = std::max(stretch.rms_area_change, report.rms_area_change);
        stretch.resident_bytes = resident_bytes();
        frames_not_ok += report.status == Status::ok ? 0 : 1;
        progress.show(report);
    }
    if (simulation.breakdown()) {
        failures.push_back("broke down in frame " + std::to_string(simulation.breakdown()->frame) + ": " +
                           simulation.breakdown()->what);
    } else {
        failures = drift(stretches, settling_stretches,
                         limits_of(simulation.cloth(), scene.gravity, stretches[settling_stretches].max_area_change));
    }
    if (device_bytes(simulation) != bytes_before) failures.emplace_back("the memory on the device changed");

    nlohmann::ordered_json document{{"scene", scene_file},
                                    {"changes", changes},
                                    {"device", device.name},
                                    {"frames", frames},
                                    {"time_step", scene.time_step},
                                    {"frames_not_ok", frames_not_ok},
                                    {"settling_stretches", settling_stretches},
                                    {"device_bytes", bytes_before},
                                    {"failures", failures},
                                    {"stretches", nlohmann::ordered_json::array()}};
    for (const Stretch& stretch : stretches) document["stretches"].push_back(to_json(stretch));
    WholeFile file(out);
    file.write(document.dump(1) + "\n");
    file.commit();
    for (const std::string& failure : failures) std::fprintf(stderr, "error: %s\n", failure.c_str());
    if (failures.empty()) std::printf("%d frames, nothing drifts: %s\n", frames, out.c_str());
    return failures.empty() ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
    try {
        if (count < 4) throw InputError("usage: apsl_long_run SCENE FRAMES OUT.json [path=value]...");
        return run(arguments[1], positive_number(arguments[2]), arguments[3], {arguments + 4, arguments + count});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 2;
    }
}
