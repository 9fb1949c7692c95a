// SPDX-License-Identifier: MIT
// Whole steps of a stand-alone cloth: on the device, by the reference, and what the report says of them.
#include "run/filter_stage.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_tethers.hpp"
#include "run/simulation.hpp"
#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

using namespace apsl;
using namespace apsl::scenes;

namespace {

// A curtain of 17×17 that falls; `rest` adds keys.
Scene parse(const std::string& rest) {
    return parse_scene(nlohmann::json::parse(R"({"mesh": {"grid": {"vertices": [17, 17]}}, "steps_per_frame": 2,
        "time_step": 0.0125, "integrator": {"stand_alone": {"damping": 0.5}},
        "strain_limiting": {"stretch_ceiling": 1.1, "sub_steps": 20}, )" +
                                             rest + "}"),
                       "scene.json");
}

const std::string corners = R"("pins": [{"vertices": [0, 16]}])";
// One corner stays, the other is led round and then held.
const std::string led = R"("pins": [{"vertices": [0]}, {"vertices": [16], "motion": {"stop": 0.2,
    "rotate": {"axis": [0, 1, 0], "degrees_per_second": 90, "center": [-0.5, 0, -0.5]}}}])";

struct Run {
    ClothState cloth;
    std::vector<FrameReport> frames;
};

Run run(const Scene& scene, Backend backend, int frames, double away = 0.0) {
    SceneCloth cloth = make_scene_cloth(scene);
    for (double& coordinate : cloth.state.positions) coordinate += away;
    for (double& coordinate : cloth.state.rest_positions) coordinate += away;
    FilterStage stage =
        make_filter_stage(scene, cloth.state, backend,
                          backend == Backend::opencl ? std::optional(choose_opencl_device({})) : std::nullopt, false);
    Simulation simulation(scene, std::move(cloth), std::move(stage), true);
    Run result;
    for (int frame = 0; frame < frames; ++frame) result.frames.push_back(simulation.run_frame());
    CHECK(!simulation.breakdown());
    result.cloth = simulation.cloth();
    return result;
}

double greatest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double greatest = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) greatest = std::max(greatest, std::abs(a[n] - b[n]));
    return greatest;
}

}  // namespace

TEST_CASE("stand-alone: a mesh without hinges has nothing to bend") {
    const test::TemporaryFolder folder;
    const std::string mesh = folder.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto bent = [&](const std::string& bending) {
        return run(
            parse_scene(nlohmann::json::parse(R"({"mesh": {"file": ")" + mesh + R"("}, "pins": [{"vertices": [0]}],
            "integrator": {"stand_alone": {"bending": )" +
                                              bending + R"(}}, "strain_limiting": {"stretch_ceiling": 1.1}})"),
                        "scene.json"),
            Backend::opencl, 3);
    };
    CHECK(bent("1e-3").cloth.positions == bent("0").cloth.positions);
}

TEST_CASE("stand-alone: the device does what the reference does, pins that move included") {
    for (const std::string& pins : {corners, led}) {
        CAPTURE(pins);
        const Scene scene = parse(pins);
        const Run device = run(scene, Backend::opencl, 6);
        const Run reference = run(scene, Backend::reference, 6);
        // m. The cloth has fallen 7 cm by then, and a fold is a matter of rounding.
        CHECK(greatest_difference(device.cloth.positions, reference.cloth.positions) < 1e-3);
        for (std::size_t n = 0; n < 6; ++n) {
            CHECK(device.frames[n].max_area_change ==
                  Approx(reference.frames[n].max_area_change).epsilon(0.05).margin(2e-4));
            CHECK(device.frames[n].max_principal_stretch ==
                  Approx(reference.frames[n].max_principal_stretch).epsilon(0.005));
            CHECK(device.frames[n].energy.total() == Approx(reference.frames[n].energy.total()).epsilon(0.01));
        }
        CHECK(device.frames.back().energy.gravity < -0.05);
    }
}

TEST_CASE("stand-alone: the same bytes twice") {
    const Scene scene = parse(led);
    const Run first = run(scene, Backend::opencl, 12), second = run(scene, Backend::opencl, 12);
    CHECK(first.cloth.positions == second.cloth.positions);
    CHECK(first.cloth.velocities == second.cloth.velocities);
}

TEST_CASE("stand-alone: pins are where their motion has them, and those at rest do not move by one bit") {
    const Scene scene = parse(led);
    for (const Backend backend : {Backend::opencl, Backend::reference}) {
        const Run moving = run(scene, backend, 4);    // 0.1 s of 0.2
        const Run stopped = run(scene, backend, 12);  // 0.3 s
        const auto corner = [](const Run& run, std::size_t axis) { return run.cloth.positions[3 * 16 + axis]; };
        // 1 m from the corner that stays: 9° and 18° about y, by the right-hand rule from x towards −z.
        constexpr double degree = 0.017453292519943295;
        CHECK(corner(moving, 0) == Approx(-0.5 + std::cos(9.0 * degree)).margin(1e-6));
        CHECK(corner(moving, 2) == Approx(-0.5 - std::sin(9.0 * degree)).margin(1e-6));
        CHECK(corner(stopped, 0) == Approx(-0.5 + std::cos(18.0 * degree)).margin(1e-6));
        CHECK(corner(stopped, 2) == Approx(-0.5 - std::sin(18.0 * degree)).margin(1e-6));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CHECK(stopped.cloth.velocities[3 * 16 + axis] == 0.0);
            CHECK(stopped.cloth.positions[axis] == stopped.cloth.rest_positions[axis]);
        }
        CHECK(stopped.frames.back().max_principal_stretch < 1.13);
    }
}

TEST_CASE("stand-alone: the device's own pinned corner goes with the motion too") {
    // What hangs beside the corner knows where it is on the device alone.
    const Run run_led = run(parse(led), Backend::opencl, 12);
    CHECK(run_led.frames.back().max_edge_stretch < 1.12);
    CHECK(run_led.frames.back().min_edge_stretch > 0.88);
}

TEST_CASE("stand-alone: a clamped strip hangs as far as its rigidity lets it, on the device and by the reference") {
    // Free by 0.5 m. By the converged solution its tip is 0.1842 and 0.4478 m below the clamp, without bending 0.505.
    for (const auto& [bending, tip, iterations] : {std::tuple{0.1, 0.1842, 6}, std::tuple{0.01, 0.4478, 2}}) {
        const Scene scene = parse_scene(
            nlohmann::json::parse(
                R"({"mesh": {"grid": {"vertices": [22, 5], "size": [0.525, 0.1], "diagonals": "uniform"}}, "density": 0.2,
                "pins": [{"box": {"max": [-0.23, 1, 1]}}], "time_step": 0.016666667,
                "integrator": {"stand_alone": {"damping": 2, "bending": )" +
                std::to_string(bending) + R"(}}, "strain_limiting": {"stretch_ceiling": 1.01, "sub_steps": 30}})"),
            "scene.json");
        const SceneCloth cloth = make_scene_cloth(scene);
        CHECK(limiting_of(scene, cloth.state).parameters.bending_iterations == iterations);
        for (const Backend backend : {Backend::opencl, Backend::reference}) {
            const Run result = run(scene, backend, 240);
            CAPTURE(bending, backend == Backend::opencl);
            CHECK(-result.cloth.positions[3 * (2 * 22 + 21) + 1] == Approx(tip).epsilon(0.03));
        }
    }
}

TEST_CASE("stand-alone: far from the origin the device does bit for bit what it does there") {
    const Scene scene = parse(corners);
    const Run here = run(scene, Backend::opencl, 6);
    const Run away = run(scene, Backend::opencl, 6, 1024.0);
    std::vector<double> brought_back = away.cloth.positions;
    for (double& coordinate : brought_back) coordinate -= 1024.0;
    CHECK(greatest_difference(brought_back, here.cloth.positions) < 1e-12);
    CHECK(away.cloth.velocities == here.cloth.velocities);
}

TEST_CASE("stand-alone: the report tells the parts of a frame's time apart") {
    for (const Backend backend : {Backend::opencl, Backend::reference}) {
        double least_unaccounted = 1.0;  // s; the process may be held up between any two parts
        for (const FrameReport& frame : run(parse(led), backend, 6).frames) {
            CHECK(frame.sub_steps >= 40);
            CHECK(frame.integrator_seconds == 0.0);
            CHECK(frame.collision_seconds == 0.0);
            CHECK(frame.filter_seconds > 0.0);
            CHECK(frame.pin_seconds > 0.0);
            CHECK(frame.step_seconds >= frame.pin_seconds + frame.filter_seconds);
            least_unaccounted =
                std::min(least_unaccounted, frame.step_seconds - frame.pin_seconds - frame.filter_seconds);
            CHECK((frame.read_back_seconds > 0.0) == (backend == Backend::opencl));
            CHECK(frame.measuring_seconds > 0.0);
        }
        CHECK(least_unaccounted < 1e-3);
    }
}

namespace {

// m, how deep the deepest free vertex is in any of the colliders where they are at `time`.
double deepest(const Scene& scene, const ClothState& cloth, double time) {
    double depth = 0.0;
    for (const MovingCollider& collider : scene.colliders)
        depth = std::max(
            depth, start_inside(cloth, collider_step(collider, time - scene.time_step, scene.time_step).shape).depth);
    return depth;
}

const std::string drape = R"("colliders": [
    {"sphere": {"center": [0.05, -0.21, 0], "radius": 0.2, "friction": 0.4, "thickness": 0.005},
     "motion": {"rotate": {"axis": [0, 1, 0], "degrees_per_second": 180}, "start": 0.2}},
    {"plane": {"point": [0, -0.45, 0], "normal": [0, 1, 0], "friction": 0.6, "thickness": 0.005}},
    {"capsule": {"a": [-0.6, -0.25, 0.3], "b": [0.6, -0.25, 0.3], "radius": 0.05, "friction": 0.2}}])";

}  // namespace

TEST_CASE("stand-alone: what falls on colliders stays outside of them, within its ceiling") {
    const Scene scene = parse(drape);
    CHECK(scene.strain_limiting->options.keeps_contacts);
    for (const int frames : {8, 20, 40}) {
        const Run fallen = run(scene, Backend::opencl, frames);
        const double time = 2 * frames * scene.time_step;
        CHECK(deepest(scene, fallen.cloth, time) < 2e-4);
        const FrameReport& last = fallen.frames.back();
        CHECK(last.max_principal_stretch < 1.15);
        CHECK(last.max_area_change < 0.08);
        CHECK(last.collision_seconds > 0.0);
    }
}

TEST_CASE("stand-alone: on colliders too the device does what the reference does, and the same bytes twice") {
    const Scene scene = parse(drape);
    const Run device = run(scene, Backend::opencl, 8), reference = run(scene, Backend::reference, 8);
    CHECK(greatest_difference(device.cloth.positions, reference.cloth.positions) < 2e-3);
    CHECK(device.cloth.positions == run(scene, Backend::opencl, 8).cloth.positions);
}

TEST_CASE("stand-alone: a floor that moves takes the cloth along") {
    const Scene scene = parse(R"("colliders": [{"plane": {"point": [0, 0, 0], "friction": 0.8},
        "motion": {"translate": {"velocity": [1, 0.5, 0]}}}])");
    for (const Backend backend : {Backend::opencl, Backend::reference}) {
        const Run carried = run(scene, backend, 20);  // 0.5 s; 1 m/s is reached after 0.13 s
        for (std::size_t v = 0; v < 289; ++v) {
            CHECK(carried.cloth.positions[3 * v + 1] == Approx(0.25).margin(2e-5));
            CHECK(carried.cloth.velocities[3 * v] == Approx(1.0).margin(0.02));
        }
    }
}

TEST_CASE("stand-alone: a thin rod that is swung does not pass through the cloth") {
    // 20 cm a step, twice its thickness, which is more than the edges are long.
    const Scene scene = parse(corners + R"(, "gravity": [0, 0, 0], "colliders": [{"capsule":
        {"a": [-1, -1.05, 0.2], "b": [1, -1.05, 0.2], "radius": 0.05}, "motion": {"translate": {"velocity": [0, 16, 0]},
        "stop": 0.075}}])");
    const Run hit = run(scene, Backend::opencl, 3);  // 0.075 s, 1.2 m
    // It is 0.15 m above where the sheet was, and each column of vertices lies over it.
    for (std::size_t column = 0; column < 17; ++column) {
        double highest = 0.0;
        for (std::size_t row = 0; row < 17; ++row)
            highest = std::max(highest, hit.cloth.positions[3 * (17 * row + column) + 1]);
        CAPTURE(column);
        CHECK(highest > 0.18);
    }
    CHECK(deepest(scene, hit.cloth, 0.075) < 2e-4);
}

TEST_CASE("stand-alone: what starts inside a collider is led out without a bounce") {
    const Scene scene = parse(R"("gravity": [0, 0, 0], "colliders": [{"plane": {"point": [0, 0.05, 0]}}])");
    const Run led_out = run(scene, Backend::opencl, 60);
    double fastest = 0.0;
    for (const FrameReport& frame : led_out.frames) fastest = std::max(fastest, frame.max_speed);
    CHECK(fastest < 0.02);  // at once it would be 4 m/s
    CHECK(led_out.cloth.positions[1] == Approx(0.05).margin(1.1e-4));
}

TEST_CASE("stand-alone: a number that is not finite ends the run and is named") {
    const Scene scene = parse(corners);
    SceneCloth cloth = make_scene_cloth(scene);
    cloth.state.velocities[3 * 100 + 1] = std::numeric_limits<double>::quiet_NaN();
    FilterStage stage = make_filter_stage(scene, cloth.state, Backend::opencl, choose_opencl_device({}), false);
    Simulation simulation(scene, std::move(cloth), std::move(stage), false);
    CHECK(simulation.run_frame().status == Status::diverged);
    REQUIRE(simulation.breakdown());
    CHECK(simulation.breakdown()->step == 0);
    CHECK(simulation.breakdown()->stage == "stand_alone");
    CHECK_THAT(simulation.breakdown()->what, Catch::Contains("first at vertex 100"));
}

TEST_CASE("stand-alone: tethers are as long far from the origin as near to it", "[scenes][tethers]") {
    const Scene scene = parse(corners);
    SceneCloth cloth = make_scene_cloth(scene);
    const StrainLimiting limiting = limiting_of(scene, cloth.state);
    const Tethers near = scene_tethers(cloth.state, limiting);
    for (double& coordinate : cloth.state.rest_positions) coordinate += 1e7;
    const Tethers far = scene_tethers(cloth.state, limiting);
    CHECK(far.anchors == near.anchors);
    for (std::size_t t = 0; t < near.lengths.size(); ++t) CHECK(far.lengths[t] == Approx(near.lengths[t]).margin(1e-6));
}

TEST_CASE("tethers of a stand-alone cloth: what is held out of their reach is not thrown about") {
    // Each holds some vertices further from their pins than the tethers are long: a ball that lifts a sheet with pinned
    // corners, a start that is stretched, and tethers that are too short.
    const auto greatest = [](const std::string& more, const std::string& stand_alone) {
        const Scene scene = parse_scene(
            nlohmann::json::parse(
                R"({"mesh": {"grid": {"vertices": [13, 13], "plane": "horizontal"}}, "integrator": {"stand_alone": )" +
                stand_alone + R"(}, "strain_limiting": {"stretch_ceiling": 1.1}, )" + more + "}"),
            "scene.json");
        double area_change = 0.0, speed = 0.0;
        for (const FrameReport& frame : run(scene, Backend::opencl, 60).frames) {
            area_change = std::max(area_change, frame.max_area_change);
            speed = std::max(speed, frame.max_speed);
        }
        return std::pair(area_change, speed);
    };
    const std::string ball = R"("pins": [{"vertices": [0, 12, 156, 168]}], "colliders": [{"sphere": {
        "center": [0, -0.35, 0], "radius": 0.2}, "motion": {"translate": {"velocity": [0, 0.5, 0]}, "stop": 1}}])";
    const std::string stretched = R"("pins": [{"vertices": [0, 12]}], "start": {"scale": [1.2, 1.2, 1.2]})";
    const std::string plain = R"("pins": [{"vertices": [0, 12]}])";
    for (const auto& [more, tethered] : {std::pair(ball, std::string("{}")), std::pair(stretched, std::string("{}")),
                                         std::pair(plain, std::string(R"({"tethers": 0.9})"))}) {
        const auto [area_change, speed] = greatest(more, tethered);
        const auto [area_change_without, speed_without] = greatest(more, R"({"tethers": 0})");
        CAPTURE(more, area_change, area_change_without, speed, speed_without);
        CHECK(area_change <= 1.5 * area_change_without);
        CHECK(speed <= 1.5 * speed_without);
    }
}

TEST_CASE("pins of one triangle that part along its edge throw nothing about, with tethers and without") {
    // The triangle's stretch is that of the pinned edge, which its third corner can do nothing for.
    for (const char* stand_alone : {"{}", R"({"tethers": 0})"})
        for (const double speed : {0.05, 0.2}) {
            const Scene scene = parse_scene(
                nlohmann::json::parse(
                    R"({"mesh": {"grid": {"vertices": [25, 25]}}, "integrator": {"stand_alone": )" +
                    std::string(stand_alone) +
                    R"(}, "strain_limiting": {"stretch_ceiling": 1.1}, "pins": [{"vertices": [11]}, {"vertices": [12],
                    "motion": {"stop": 0.5, "translate": {"velocity": [)" +
                    std::to_string(speed) + ", 0, 0]}}}]}"),
                "scene.json");
            double area_change = 0.0, greatest_speed = 0.0;
            for (const FrameReport& frame : run(scene, Backend::opencl, 60).frames) {
                area_change = std::max(area_change, frame.max_area_change);
                greatest_speed = std::max(greatest_speed, frame.max_speed);
            }
            CAPTURE(stand_alone, speed, area_change, greatest_speed);
            CHECK(area_change < 0.3);
            CHECK(greatest_speed < 20.0);
        }
}

TEST_CASE("pins that come near to one another, or draw a triangle apart, do not throw the cloth about") {
    struct Pins {
        const char* document;
        double greatest_speed, greatest_gain;  // m/s, J
    };
    const auto moved = [](int vertex, const char* velocity, const char* stop) {
        return R"({"vertices": [)" + std::to_string(vertex) + R"(], "motion": {"start": 0.1, "stop": )" + stop +
               R"(, "translate": {"velocity": )" + velocity + "}}}";
    };
    // Two close from 62.5 to 2.5 mm. All three corners of a triangle part, by 40 mm each. The cloth weighs 0.2 kg, and
    // swings down from 0 J.
    const std::string near = moved(144, "[0.2, 0, 0]", "0.25") + ", " + moved(145, "[-0.2, 0, 0]", "0.25"),
                      apart = moved(144, "[-0.2, 0, 0]", "0.3") + ", " + moved(145, "[0.2, 0, 0]", "0.3") + ", " +
                              moved(161, "[0, 0, 0.2]", "0.3");
    for (const auto& [document, greatest_speed, greatest_gain] :
         {Pins{near.c_str(), 15.0, 0.05}, Pins{apart.c_str(), 10.0, 0.1}})
        for (const char* stand_alone : {"{}", R"({"tethers": 0})"}) {
            const Scene scene = parse_scene(
                nlohmann::json::parse(
                    R"({"mesh": {"grid": {"vertices": [17, 17], "plane": "horizontal", "diagonals": "alternating"}},
                        "density": 0.2, "start": {"random": 0.001}, "strain_limiting": {"stretch_ceiling": 1.1},
                        "integrator": {"stand_alone": )" +
                    std::string(stand_alone) + R"(}, "pins": [)" + document + "]}"),
                "scene.json");
            double speed = 0.0, gain = 0.0;
            for (const FrameReport& frame : run(scene, Backend::opencl, 40).frames) {
                speed = std::max(speed, frame.max_speed);
                gain = std::max(gain, frame.energy.kinetic + frame.energy.gravity);
            }
            CAPTURE(document, stand_alone, speed, gain);
            CHECK(speed < greatest_speed);
            CHECK(gain < greatest_gain);
        }
}

namespace {

/// A sheet of 0.2 kg that falls about two neighbouring pins within it, which part by 5 cm, in 1/240 s.
Scene sheet_at_parting_pins(const std::string& more_pins, const std::string& colliders) {
    return parse_scene(
        nlohmann::json::parse(
            R"({"mesh": {"grid": {"vertices": [17, 17], "plane": "horizontal", "diagonals": "alternating"}},
            "density": 0.2, "time_step": 0.004166667, "start": {"random": 0.001},
            "integrator": {"stand_alone": {}}, "strain_limiting": {"stretch_ceiling": 1.1},
            "pins": [{"vertices": [144]},
                     {"vertices": [145], "motion": {"translate": {"velocity": [0.1, 0, 0]}, "stop": 0.5}})" +
            more_pins + R"(], "colliders": [)" + colliders + "]}"),
        "scene.json");
}

double greatest_kinetic_energy(const Run& run) {
    double kinetic = 0.0;  // J
    for (const FrameReport& frame : run.frames) kinetic = std::max(kinetic, frame.energy.kinetic);
    return kinetic;
}

double greatest_gain(const Run& run) {
    double gain = 0.0;  // J, of motion and height; 0 at the start
    for (const FrameReport& frame : run.frames) gain = std::max(gain, frame.energy.kinetic + frame.energy.gravity);
    return gain;
}

}  // namespace

TEST_CASE("energy: a body far away lets no more pass, however fast it is") {
    const auto sphere = [](const std::string& more) {
        return R"({"sphere": {"center": [30, 0, 0], "radius": 1})" + more + "}";
    };
    const Run still = run(sheet_at_parting_pins("", sphere("")), Backend::opencl, 90);
    const Run moving = run(sheet_at_parting_pins("", sphere(R"(, "motion": {"translate": {"velocity": [0, 3, 0]}})")),
                           Backend::opencl, 90);
    CHECK(greatest_gain(still) < 0.05);
    CHECK(moving.cloth.positions == still.cloth.positions);
}

TEST_CASE("energy: pins that only turn slowly do not feed a torn spot step by step") {
    // Two corners turn by 5°/s about their middle. Were their speed granted anew in each step, it would come to 9 J.
    const std::string turning = R"(, {"vertices": [0, 16], "motion": {"rotate": {"degrees_per_second": 5}}})";
    const Run turned = run(sheet_at_parting_pins(turning, ""), Backend::opencl, 480);
    CHECK(greatest_gain(turned) < 0.2);
    const auto slowed = [](const FrameReport& frame) { return frame.energy_kept < 1.0; };
    CHECK(std::any_of(turned.frames.begin(), turned.frames.end(), slowed));
}

TEST_CASE("energy: pins that spread a little beyond the ceiling do not shake the cloth") {
    // The top row is spread to 1.14 of its width in 0.3 s. Rows over their ceiling by 0.04 would throw it about with
    // 0.3 to 8 J, the more the shorter the step.
    std::string pins;
    for (int i = 0; i <= 16; ++i)
        pins += (i > 0 ? ", " : "") + std::string(R"({"vertices": [)") + std::to_string(i) +
                R"(], "motion": {"start": 0.1, "stop": 0.4, "translate": {"velocity": [)" +
                std::to_string(0.4667 * i / 16) + ", 0, 0]}}}";
    for (const auto& [time_step, frames] : {std::pair("0.016666667", 36), {"0.004166667", 144}}) {
        const Scene scene = parse_scene(
            nlohmann::json::parse(
                R"({"mesh": {"grid": {"vertices": [17, 17], "plane": "vertical", "diagonals": "alternating"}},
                "density": 0.2, "start": {"random": 0.002}, "integrator": {"stand_alone": {}}, "colliders": [],
                "strain_limiting": {"stretch_ceiling": 1.1}, "time_step": )" +
                std::string(time_step) + R"(, "pins": [)" + pins + "]}"),
            "scene.json");
        const double kinetic = greatest_kinetic_energy(run(scene, Backend::opencl, frames));
        CAPTURE(time_step, kinetic);
        CHECK(kinetic < 0.08);
    }
}

TEST_CASE("energy: a sheet that is pinned all around and too large for that springs out gently") {
    // Its rest areas are 1.06 of its areas. In 1/240 s it would spring out with 8 J.
    for (const auto& [time_step, frames] : {std::pair("0.016666667", 45), {"0.004166667", 180}}) {
        const Scene scene =
            parse_scene(nlohmann::json::parse(
                            R"({"mesh": {"grid": {"vertices": [17, 17], "plane": "horizontal"}}, "density": 0.2,
                "start": {"rest_areas": 1.06, "random": 0.001}, "integrator": {"stand_alone": {}}, "colliders": [],
                "strain_limiting": {"stretch_ceiling": 1.01}, "time_step": )" +
                            std::string(time_step) +
                            R"(, "pins": [{"box": {"max": [-0.49, 9, 9]}}, {"box": {"min": [0.49, -9, -9]}},
                             {"box": {"max": [9, 9, -0.49]}}, {"box": {"min": [-9, -9, 0.49]}}]})"),
                        "scene.json");
        const Run sprung = run(scene, Backend::opencl, frames);
        const double kinetic = greatest_kinetic_energy(sprung), gravity = sprung.frames.back().energy.gravity;
        CAPTURE(time_step, kinetic, gravity);
        CHECK(kinetic < 0.05);
        CHECK(gravity < -0.01);  // it hangs through
    }
}

TEST_CASE("energy: a torn sheet that its pins draw over a rough floor is not fed by the floor") {
    // All three corners of a triangle part by 5 cm in a second while they walk at 1.5 m/s; the floor is 0.4 m below.
    const Scene scene =
        parse_scene(nlohmann::json::parse(
                        R"({"mesh": {"grid": {"vertices": [17, 17], "plane": "horizontal", "diagonals": "alternating"}},
            "density": 0.2, "start": {"random": 0.001}, "integrator": {"stand_alone": {}},
            "strain_limiting": {"stretch_ceiling": 1.1},
            "pins": [{"vertices": [144], "motion": {"translate": {"velocity": [1.45, 0, 0]}}},
                     {"vertices": [145], "motion": {"translate": {"velocity": [1.55, 0, 0]}}},
                     {"vertices": [161], "motion": {"translate": {"velocity": [1.5, 0, 0.05]}}}],
            "colliders": [{"plane": {"point": [0, -0.4, 0], "normal": [0, 1, 0], "friction": 0.5}}]})"),
                    "scene.json");
    CHECK(greatest_kinetic_energy(run(scene, Backend::opencl, 60)) <
          1.5);  // J; at 1.5 m/s it has 0.23, and 9 were it fed
}

TEST_CASE("energy: a clamped strip swings on at the same rate, however few its sub-steps") {
    // Its clamp is turned by 60° within 0.1 s.
    for (const int sub_steps : {3, 30}) {
        const Scene scene = parse_scene(
            nlohmann::json::parse(
                R"({"mesh": {"grid": {"vertices": [21, 4], "size": [0.5, 0.075], "plane": "horizontal", "diagonals": "alternating"}},
                "pins": [{"box": {"max": [-0.22, 9, 9]}, "motion": {"stop": 0.1,
                "rotate": {"axis": [0, 0, 1], "degrees_per_second": 600, "center": [-0.25, 0, 0]}}}],
                "gravity": [0, 0, 0], "time_step": 0.004166667, "colliders": [],
                "integrator": {"stand_alone": {"damping": 0, "bending": 0.1, "tethers": 0}},
                "strain_limiting": {"stretch_ceiling": 1.1, "sub_steps": )" +
                std::to_string(sub_steps) + "}}"),
            "scene.json");
        double energy = 0.0;  // J, the mean from 0.45 to 0.6 s
        const std::vector<FrameReport> frames = run(scene, Backend::opencl, 144).frames;
        for (std::size_t n = 108; n < 144; ++n) energy += frames[n].energy.kinetic / 36.0;
        CAPTURE(sub_steps, energy);
        CHECK(energy > 0.014);
        CHECK(energy < 0.020);
    }
}

TEST_CASE("energy: pins that leave a spot of the cloth no room do not hold up the rest of its fall") {
    const Run fallen = run(sheet_at_parting_pins("", ""), Backend::opencl, 120);
    double height = 0.0;
    for (std::size_t n = 1; n < fallen.cloth.positions.size(); n += 3) height += fallen.cloth.positions[n] / (17 * 17);
    CHECK(height < -0.15);  // m; it would hang in the air at -0.08
}

TEST_CASE("energy: a piece that pins tear does not slow another piece of the mesh") {
    // A sheet that swings from a corner, alone and beside one that is torn.
    const auto sheet = [](double x, int first, const std::string& faces) {
        std::string text;
        for (int row = 0; row < 9; ++row)
            for (int column = 0; column < 9; ++column)
                text += "v " + std::to_string(x + column / 8.0) + " 0 " + std::to_string(row / 8.0) + "\n";
        std::string triangles = faces;
        for (int row = 0; row < 8; ++row)
            for (int column = 0; column < 8; ++column) {
                const int a = first + 9 * row + column;
                const auto face = [&](int p, int q, int r) {
                    triangles += "f " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
                };
                face(a, a + 9, a + 1);
                face(a + 1, a + 9, a + 10);
            }
        return std::pair(text, triangles);
    };
    const test::TemporaryFolder folder;
    const auto [torn_vertices, torn_faces] = sheet(0.0, 1, "");
    const auto [swinging, both_faces] = sheet(2.0, 82, torn_faces);
    const std::string both = folder.write("both.obj", torn_vertices + swinging + both_faces);
    const auto [alone_vertices, alone_faces] = sheet(2.0, 1, "");
    const std::string alone = folder.write("alone.obj", alone_vertices + alone_faces);
    const auto mean_speed = [](const std::string& mesh, const std::string& pins, std::size_t first) {
        const Scene scene = parse_scene(nlohmann::json::parse(R"({"mesh": {"file": ")" + mesh +
                                                              R"("}, "integrator": {"stand_alone": {}}, "colliders": [],
                "strain_limiting": {"stretch_ceiling": 1.1}, "pins": [)" +
                                                              pins + "]}"),
                                        "scene.json");
        const Run end = run(scene, Backend::opencl, 60);
        double sum = 0.0;
        for (std::size_t n = 3 * first; n < 3 * (first + 81); n += 3)
            sum += std::hypot(end.cloth.velocities[n], end.cloth.velocities[n + 1], end.cloth.velocities[n + 2]) / 81.0;
        return sum;
    };
    const double beside = mean_speed(both, R"({"vertices": [0, 9, 18]}, {"vertices": [8, 17, 26], "motion":
        {"start": 0.3, "stop": 0.8, "translate": {"velocity": [1, 0, 0]}}}, {"vertices": [81]})",
                                     81);
    const double by_itself = mean_speed(alone, R"({"vertices": [0]})", 0);
    CAPTURE(beside, by_itself);
    CHECK(beside > 0.3 * by_itself);  // it would stand all but still, at 0.03 m/s
}
