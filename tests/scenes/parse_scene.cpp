// SPDX-License-Identifier: MIT
#include "run/parse_scene.hpp"

#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::scenes;
using apsl::test::input_error_of;
using apsl::test::TemporaryFolder;

namespace {

Scene parse(const std::string& text) {
    return parse_scene(nlohmann::json::parse(text), "folder/scene.json");
}

std::string error_of(const std::string& text) {
    return input_error_of([&] { parse(text); });
}

}  // namespace

TEST_CASE("every key but mesh has a default, and what is not named is not there") {
    const Scene scene = parse(R"({"mesh": {"grid": {}}})");
    const GridMesh& grid = std::get<GridMesh>(scene.mesh);
    CHECK(grid.vertices == std::array<std::uint32_t, 2>{65, 65});
    CHECK(grid.size == std::array<double, 2>{1.0, 1.0});
    CHECK(grid.diagonals == Diagonals::alternating);
    CHECK(grid.jitter == 0.0);
    CHECK(grid.plane == GridPlane::horizontal);
    CHECK(scene.density == 0.2);
    CHECK(scene.pins.empty());
    CHECK(scene.masses.empty());
    CHECK(scene.start.scale == std::array<double, 3>{1.0, 1.0, 1.0});
    CHECK(scene.start.random == 0.0);
    CHECK(scene.start.rest_areas == 1.0);
    CHECK(scene.gravity == std::array<double, 3>{0.0, -9.81, 0.0});
    CHECK(scene.time_step == 1.0 / 60.0);
    CHECK(scene.steps_per_frame == 1);
    CHECK(scene.frames == 180);
    CHECK(std::holds_alternative<NoIntegrator>(scene.integrator));
    CHECK_FALSE(scene.strain_limiting.has_value());
    CHECK(scene.colliders.empty());
    CHECK_FALSE(parse(R"({"mesh": {"grid": {}}, "strain_limiting": null})").strain_limiting.has_value());
}

TEST_CASE("a stage that is named without values takes the defaults of the stage") {
    const Scene scene = parse(R"({"mesh": {"tube": {}}, "time_step": 0.01, "integrator": {"implicit_springs": {}},
        "strain_limiting": {}, "colliders": [{"sphere": {}}, {"plane": {}}, {"capsule": {}}]})");
    const auto& springs = std::get<ImplicitSpringsIntegrator>(scene.integrator);
    CHECK(springs.stretch_stiffness == 20.0);
    CHECK(springs.bend_stiffness == 0.01);
    CHECK(springs.damping == 0.5);
    REQUIRE(scene.strain_limiting.has_value());
    const Parameters defaults;
    CHECK(scene.strain_limiting->options.matrix == Matrix::consistent);
    CHECK(scene.strain_limiting->options.apply == Apply::matrix_free);
    CHECK(scene.strain_limiting->parameters.time_step == 0.01f);
    CHECK(scene.strain_limiting->parameters.regularization == defaults.regularization);
    CHECK(scene.strain_limiting->parameters.sub_steps == defaults.sub_steps);
    CHECK(scene.strain_limiting->parameters.target_area_change == defaults.target_area_change);
    CHECK(scene.strain_limiting->parameters.tolerance == defaults.tolerance);
    CHECK(scene.strain_limiting->parameters.max_iterations == defaults.max_iterations);
    CHECK(scene.strain_limiting->parameters.adaptive_threshold == defaults.adaptive_threshold);
    CHECK(scene.strain_limiting->parameters.first_regularization == defaults.first_regularization);
    CHECK(scene.strain_limiting->options.warm_start_sub_steps == 0);
    CHECK(scene.strain_limiting->options.execution == Execution::automatic);
    CHECK(scene.strain_limiting->options.solver == Solver::automatic);
    CHECK(scene.strain_limiting->options.bound_interval == 1);
    CHECK(scene.strain_limiting->regularization.empty());
    CHECK(scene.colliders.size() == 3);
}

TEST_CASE("a stand-alone scene is whole steps under its gravity and damping") {
    const Scene scene =
        parse(R"({"mesh": {"grid": {}}, "gravity": [1, -2, 3], "integrator": {"stand_alone": {"damping": 0.25}},
                                  "strain_limiting": {"stretch_ceiling": 1.1}})");
    CHECK(std::get<StandAloneIntegrator>(scene.integrator).damping == 0.25);
    REQUIRE(scene.strain_limiting);
    CHECK(scene.strain_limiting->options.integrates);
    CHECK(scene.strain_limiting->parameters.acceleration == std::array<float, 3>{1.0f, -2.0f, 3.0f});
    CHECK(scene.strain_limiting->parameters.damping == 0.25f);
    CHECK(!scene.strain_limiting->options.bends);
    CHECK(scene.strain_limiting->tethers == 1.0f);
    const Scene stiff = parse(R"({"mesh": {"grid": {}}, "integrator": {"stand_alone": {"bending": 0.5}},
                                  "strain_limiting": {"stretch_ceiling": 1.1}})");
    CHECK(stiff.strain_limiting->options.bends);
    CHECK(stiff.strain_limiting->parameters.bending == 0.5f);
    const Scene loose = parse(R"({"mesh": {"grid": {}}, "integrator": {"stand_alone": {"tethers": 1.25}},
                                  "strain_limiting": {}})");
    CHECK(loose.strain_limiting->tethers == 1.25f);
    CHECK_THROWS_WITH(parse(R"({"mesh": {"grid": {}}, "integrator": {"stand_alone": {"tethers": -1}},
                               "strain_limiting": {}})"),
                      "folder/scene.json: integrator.stand_alone.tethers: expected a number ≥ 0 and ≤ 1000000, got -1");
    const Scene filtered = parse(R"({"mesh": {"grid": {}}, "strain_limiting": {}})");
    CHECK(!filtered.strain_limiting->options.integrates);
    CHECK(filtered.strain_limiting->tethers == 0.0f);
    CHECK(filtered.strain_limiting->parameters.acceleration == std::array<float, 3>{});
}

TEST_CASE("every value is taken from where it stands") {
    const Scene scene = parse(R"({
        "mesh": {"tube": {"radius": [0.1, 0.4], "height": 0.5, "segments": [24, 12], "diagonals": "random", "jitter": 0.3}},
        "density": 0.3, "gravity": [1, 2, 3], "time_step": 0.01, "steps_per_frame": 2, "frames": 7,
        "pins": [{"vertices": [3, 1]}, {"corners": ["min_x_max_y"]},
                 {"box": {"min": [0, 1, 2]}, "motion": {"rotate": {"axis": [0, 0, 2], "degrees_per_second": 90,
                  "center": [1, 1, 1]}, "start": 0.5, "stop": 2}},
                 {"vertices": [0], "motion": {"translate": {"velocity": [0, 1, 0]}}}],
        "masses": [{"vertices": [5], "factor": 1000}, {"box": {"max": [0, 0, 0]}, "factor": 0.5}],
        "start": {"scale": [1, 0, -1], "random": 0.25, "rest_areas": 1.5},
        "integrator": {"bending_springs": {"bend_stiffness": 50, "damping": 0}},
        "strain_limiting": {"matrix": "printed", "apply": "assembled_csr", "regularization": 2.5, "sub_steps": 3,
                            "target_area_change": 0.01, "tolerance": 0.001, "max_iterations": 9,
                            "adaptive_threshold": 6, "first_regularization": 1.5, "warm_start_sub_steps": 3, "execution": "many_groups"},
        "colliders": [{"sphere": {"center": [0, 1, 0], "radius": 0.2, "friction": 0.5, "thickness": 0.01}},
                      {"plane": {"point": [0, -1, 0], "normal": [0, 2, 0]}, "motion": {"translate": {"velocity": [0, 0, 1]}, "stop": 3}},
                      {"capsule": {"a": [0, 0, 0], "b": [0, 1, 0], "radius": 0.05}}]})");
    const TubeMesh& tube = std::get<TubeMesh>(scene.mesh);
    CHECK(tube.radius == std::array<double, 2>{0.1, 0.4});
    CHECK(tube.height == 0.5);
    CHECK(tube.segments == std::array<std::uint32_t, 2>{24, 12});
    CHECK(tube.diagonals == Diagonals::random);
    CHECK(tube.jitter == 0.3);
    CHECK(scene.density == 0.3);
    CHECK(scene.gravity == std::array<double, 3>{1, 2, 3});
    CHECK(scene.steps_per_frame == 2);
    CHECK(scene.frames == 7);

    REQUIRE(scene.pins.size() == 4);
    CHECK(std::get<SelectedVertices>(scene.pins[0].selection).vertices == std::vector<std::uint32_t>{3, 1});
    CHECK(std::holds_alternative<Held>(scene.pins[0].motion.path));
    CHECK(std::get<SelectedCorners>(scene.pins[1].selection).corners == std::vector<std::string>{"min_x_max_y"});
    const SelectedBox& box = std::get<SelectedBox>(scene.pins[2].selection);
    CHECK(box.min == std::array<double, 3>{0, 1, 2});
    CHECK(std::isinf(box.max[0]));
    const Rotation& rotation = std::get<Rotation>(scene.pins[2].motion.path);
    CHECK(rotation.axis == std::array<double, 3>{0, 0, 2});
    CHECK(rotation.degrees_per_second == 90);
    CHECK(rotation.center == std::array<double, 3>{1, 1, 1});
    CHECK(scene.pins[2].motion.start == 0.5);
    CHECK(scene.pins[2].motion.stop == 2.0);
    CHECK(std::get<Translation>(scene.pins[3].motion.path).velocity == std::array<double, 3>{0, 1, 0});

    REQUIRE(scene.masses.size() == 2);
    CHECK(std::get<SelectedVertices>(scene.masses[0].selection).vertices == std::vector<std::uint32_t>{5});
    CHECK(scene.masses[0].factor == 1000.0);
    CHECK(std::get<SelectedBox>(scene.masses[1].selection).max == std::array<double, 3>{0, 0, 0});
    CHECK(scene.masses[1].factor == 0.5);
    CHECK(scene.start.scale == std::array<double, 3>{1, 0, -1});
    CHECK(scene.start.random == 0.25);
    CHECK(scene.start.rest_areas == 1.5);

    const auto& springs = std::get<BendingSpringsIntegrator>(scene.integrator);
    CHECK(springs.bend_stiffness == 50);
    CHECK(springs.damping == 0);
    CHECK(!scene.strain_limiting->options.integrates);
    const StrainLimiting& limiting = scene.strain_limiting.value();
    CHECK(limiting.options.matrix == Matrix::printed);
    CHECK(limiting.options.apply == Apply::assembled_csr);
    CHECK(limiting.parameters.regularization == 2.5f);
    CHECK(limiting.parameters.sub_steps == 3);
    CHECK(limiting.parameters.target_area_change == 0.01f);
    CHECK(limiting.parameters.tolerance == 0.001f);
    CHECK(limiting.parameters.max_iterations == 9);
    CHECK(limiting.parameters.adaptive_threshold == 6);
    CHECK(limiting.parameters.first_regularization == 1.5f);
    CHECK(limiting.options.warm_start_sub_steps == 3);
    CHECK(limiting.options.execution == Execution::many_groups);

    const Sphere& sphere = std::get<Sphere>(scene.colliders[0].shape);
    CHECK(sphere.center == std::array<double, 3>{0, 1, 0});
    CHECK(sphere.radius == 0.2);
    CHECK(sphere.contact.friction == 0.5);
    CHECK(sphere.contact.thickness == 0.01);
    CHECK(std::holds_alternative<Held>(scene.colliders[0].motion.path));
    CHECK(std::get<Translation>(scene.colliders[1].motion.path).velocity == std::array<double, 3>{0, 0, 1});
    CHECK(scene.colliders[1].motion.stop == 3.0);
    CHECK(std::get<Plane>(scene.colliders[1].shape).normal == std::array<double, 3>{0, 2, 0});
    CHECK(std::get<Capsule>(scene.colliders[2].shape).b == std::array<double, 3>{0, 1, 0});
}

TEST_CASE("a mesh file is looked for beside the scene") {
    const MeshFile absolute = std::get<MeshFile>(parse(R"({"mesh": {"file": "/a/b.obj"}})").mesh);
    CHECK(absolute.file == "/a/b.obj");
    CHECK_FALSE(absolute.height.has_value());
    CHECK(absolute.weld == 0.0);
    const MeshFile relative =
        std::get<MeshFile>(parse(R"({"mesh": {"file": "b.obj", "height": 2, "weld": 0.001}})").mesh);
    CHECK(relative.file == "folder/b.obj");
    CHECK(relative.height == 2.0);
    CHECK(relative.weld == 0.001);
}

TEST_CASE("one regularization per triangle") {
    const Scene scene = parse(R"({"mesh": {"grid": {}}, "strain_limiting": {"regularization": [1, 2.5]}})");
    CHECK(scene.strain_limiting->regularization == std::vector<float>{1.0f, 2.5f});
}

TEST_CASE("a stretch ceiling, for all triangles or one for each") {
    const auto limiting = [](const std::string& value) {
        return *parse(R"({"mesh": {"grid": {}}, "strain_limiting": {"stretch_ceiling": )" + value + "}}")
                    .strain_limiting;
    };
    const StrainLimiting all = limiting("1.1");
    CHECK(all.parameters.stretch_ceiling == 1.1f);
    CHECK(all.options.limits_stretch);
    CHECK_FALSE(all.options.stretch_ceiling_per_triangle);
    const StrainLimiting each = limiting("[1.1, 0, 1.01]");
    CHECK(each.stretch_ceilings == std::vector<float>{1.1f, 0.0f, 1.01f});
    CHECK(each.options.stretch_ceiling_per_triangle);
    CHECK(each.options.limits_stretch);
    CHECK_FALSE(limiting("0").options.limits_stretch);
    const StrainLimiting none = limiting("[0, 0]");
    CHECK(none.stretch_ceilings == std::vector<float>{0.0f, 0.0f});
    CHECK(none.options == limiting("0").options);
}

TEST_CASE("what is wrong is named by its path, with what was expected") {
    const auto [rest, message] = GENERATE(table<std::string, std::string>({
        {R"("density": -1)", "density: expected a number > 0, got -1"},
        {R"("density": "heavy")", "density: expected a number > 0, got \"heavy\""},
        {R"("density": null)", "density: expected a number > 0, got null"},
        {R"("time_step": 0)", "time_step: expected a number > 0, got 0"},
        {R"("frames": 0)", "frames: expected a whole number from 1 to 2147483647, got 0"},
        {R"("frames": 1.5)", "frames: expected a whole number from 1 to 2147483647, got 1.5"},
        {R"("steps_per_frame": 0)", "steps_per_frame: expected a whole number from 1"},
        {R"("gravity": [0, 1])", "gravity: expected three numbers, got [0,1]"},
        {R"("gravity": [0, 1, "x"])", "gravity[2]: expected a number, got \"x\""},
        {R"("color": 1)",
         "color: unknown key, expected one of mesh, density, pins, masses, start, gravity, time_step, "
         "steps_per_frame, frames, integrator, strain_limiting, colliders"},
        {R"("strain_limiting": {"alpha": 2})",
         "strain_limiting.alpha: unknown key, expected one of matrix, apply, execution, warm_start_sub_steps, "
         "solver, bound_interval, regularization, sub_steps, most_sub_steps, target_area_change, tolerance, "
         "max_iterations, "
         "adaptive_threshold, first_regularization, stretch_ceiling, stepping"},
        {R"("strain_limiting": {"stretch_ceiling": 1})",
         "strain_limiting: stretch_ceiling is 1, expected 0 (areas alone) or a finite number >= 1.01"},
        {R"("strain_limiting": {"stretch_ceiling": [1.1, 1]})",
         "strain_limiting.stretch_ceiling[1]: expected 0 or a number ≥ 1.01, got 1"},
        {R"("strain_limiting": {"stretch_ceiling": 1.1, "solver": "conjugate_gradient"})",
         "strain_limiting: a stretch ceiling (limits_stretch) needs solver chebyshev"},
        {R"("strain_limiting": {"regularization": 0.99})",
         "strain_limiting.regularization: expected a number ≥ 1, got 0.99"},
        {R"("strain_limiting": {"regularization": [1, 0.5]})",
         "strain_limiting.regularization[1]: expected a number ≥ 1, got 0.5"},
        {R"("strain_limiting": {"regularization": []})",
         "strain_limiting.regularization: expected a number, or one for each triangle, got []"},
        {R"("strain_limiting": {"tolerance": 1})", "strain_limiting.tolerance: expected a number ≥ 0 and < 1, got 1"},
        {R"("strain_limiting": {"sub_steps": -1})", "strain_limiting.sub_steps: expected a whole number from 0"},
        {R"("strain_limiting": {"max_iterations": 0})",
         "strain_limiting.max_iterations: expected a whole number from 1"},
        {R"("strain_limiting": {"adaptive_threshold": -1})",
         "strain_limiting.adaptive_threshold: expected a whole number from 0"},
        {R"("strain_limiting": {"first_regularization": 0.5})",
         "strain_limiting: first_regularization is 0.5, expected 0 (the same in every sub-step) or a finite number > "
         "1"},
        {R"("strain_limiting": {"warm_start_sub_steps": 65537})",
         "strain_limiting.warm_start_sub_steps: expected a whole number from 0 to 65536, got 65537"},
        {R"("strain_limiting": {"execution": "one_group", "apply": "assembled_csr"})",
         "strain_limiting: execution is one_group, which needs the consistent matrix, matrix-free"},
        {R"("strain_limiting": {"solver": "jacobi"})",
         "strain_limiting.solver: expected one of conjugate_gradient, chebyshev, automatic, got \"jacobi\""},
        {R"("strain_limiting": {"solver": "chebyshev", "matrix": "printed"})",
         "strain_limiting: solver is chebyshev, which needs the consistent matrix, matrix-free"},
        {R"("strain_limiting": {"solver": "chebyshev", "execution": "one_group"})",
         "strain_limiting: execution is one_group, which needs solver conjugate_gradient"},
        {R"("strain_limiting": {"solver": "chebyshev", "regularization": [1.2, 1.3]})",
         "strain_limiting: solver is chebyshev, which needs one regularization for all triangles"},
        {R"("strain_limiting": {"solver": "chebyshev", "warm_start_sub_steps": 2})",
         "strain_limiting: solver is chebyshev, which takes no warm_start_sub_steps"},
        {R"("strain_limiting": {"solver": "chebyshev", "adaptive_threshold": 2})",
         "strain_limiting: adaptive_threshold is 2, expected 0: the solver is chebyshev"},
        {R"("strain_limiting": {"target_area_change": -0.1})",
         "strain_limiting.target_area_change: expected a number ≥ 0, got -0.1"},
        {R"("strain_limiting": {"matrix": "exact"})",
         "strain_limiting.matrix: expected one of consistent, printed, got \"exact\""},
        {R"("strain_limiting": [])", "strain_limiting: expected an object, got []"},
        {R"("integrator": {})",
         "integrator: is missing what it is, expected one of implicit_springs, bending_springs, stand_alone, none"},
        {R"("integrator": {"none": {}, "stand_alone": {}})", "integrator: has both stand_alone and none"},
        {R"("integrator": {"implicit_springs": {"stretch_stiffness": -1}})",
         "integrator.implicit_springs.stretch_stiffness: expected a number ≥ 0, got -1"},
        {R"("integrator": {"stand_alone": {"stretch_stiffness": 1}})",
         "integrator.stand_alone.stretch_stiffness: unknown key, expected one of damping, bending"},
        {R"("integrator": {"stand_alone": {"bend_stiffness": 200}}, "strain_limiting": {})",
         "integrator.stand_alone.bend_stiffness: a stand-alone cloth has no springs, expected bending (N·m); those in "
         "front of the filter are integrator.bending_springs"},
        {R"("integrator": {"stand_alone": {"bending": -1}}, "strain_limiting": {})",
         "integrator.stand_alone.bending: expected a number ≥ 0, got -1"},
        {R"("integrator": {"stand_alone": {"bending": 1e-4}}, "strain_limiting": {})",
         "integrator: stand_alone: bends is on, which needs limits_stretch: areas and bending alone let a cloth flow "
         "in "
         "its plane"},
        {R"("integrator": {"stand_alone": {"tethers": 1e39}}, "strain_limiting": {})",
         "integrator.stand_alone.tethers: expected a number ≥ 0 and ≤ 1000000, got 1e+39"},
        {R"("integrator": {"stand_alone": {"tethers": 1e-40}}, "strain_limiting": {})",
         "integrator.stand_alone.tethers: expected 0 (none) or a number ≥ 0.01, got 1e-40"},
        {R"("integrator": {"stand_alone": {"damping": 1e39}}, "strain_limiting": {})",
         "integrator.stand_alone.damping: expected a number that 32 bits hold, at most 3.4e38, got 1e+39"},
        {R"("integrator": {"stand_alone": {"bending": 1e39}}, "strain_limiting": {"stretch_ceiling": 1.1})",
         "integrator.stand_alone.bending: expected a number that 32 bits hold, at most 3.4e38, got 1e+39"},
        {R"("integrator": {"stand_alone": {}}, "strain_limiting": {}, "gravity": [0, -1e39, 0])",
         "gravity[1]: expected a number that 32 bits hold, at most 3.4e38, got -1e+39"},
        {R"("strain_limiting": {}, "time_step": 1e39)",
         "time_step: expected a number that 32 bits hold, at most 3.4e38, got 1e+39"},
        {R"("strain_limiting": {}, "time_step": 1e-50)",
         "time_step: expected a number > 0 that 32 bits hold, at least 1.2e-38, got 1e-50"},
        {R"("strain_limiting": {"target_area_change": 1e39})",
         "strain_limiting.target_area_change: expected a number that 32 bits hold, at most 3.4e38, got 1e+39"},
        {R"("strain_limiting": {"regularization": [1.2, 1e39]})",
         "strain_limiting.regularization[1]: expected a number that 32 bits hold, at most 3.4e38, got 1e+39"},
        {R"("integrator": {"stand_alone": {"damping": -1}}, "strain_limiting": {})",
         "integrator.stand_alone.damping: expected a number ≥ 0, got -1"},
        {R"("integrator": {"stand_alone": {}})",
         "integrator: stand_alone is a step of the limiter, expected strain_limiting beside it"},
        {R"("integrator": {"stand_alone": {}}, "strain_limiting": null)",
         "integrator: stand_alone is a step of the limiter, expected strain_limiting beside it"},
        {R"("integrator": {"stand_alone": {}}, "strain_limiting": {"execution": "one_group"})",
         "integrator: stand_alone: integrates is on, which needs execution many_groups"},
        {R"("integrator": {"stand_alone": {}}, "strain_limiting": {"sub_steps": 1})",
         "integrator: stand_alone: sub_steps is 1, expected "},
        {R"("integrator": {"stand_alone": {}}, "strain_limiting": {"stepping": "whole_step"})",
         "integrator: stand_alone: stepping is whole_step, "},
        {R"("pins": {})", "pins: expected an array, got {}"},
        {R"("pins": [{"vertices": [-1]}])", "pins[0].vertices[0]: expected a whole number from 0"},
        {R"("pins": [{"corners": ["min_x"]}, {"vertices": []}])", "pins[1].vertices: expected at least one, got []"},
        {R"("pins": [{"corners": []}])", "pins[0].corners: expected at least one, got []"},
        {R"("masses": [{"vertices": [], "factor": 2}])", "masses[0].vertices: expected at least one, got []"},
        {R"("pins": [{"box": {"low": 1}}])", "pins[0].box.low: unknown key, expected one of min, max"},
        {R"("pins": [{"vertices": [0], "motion": {"rotate": {"axis": [0, 0, 0]}}}])",
         "pins[0].motion.rotate.axis: expected an axis of any length but 0"},
        {R"("pins": [{"vertices": [0], "motion": {"rotate": {}, "start": 2, "stop": 1}}])",
         "pins[0].motion.stop: expected a number ≥ 2, got 1"},
        {R"("colliders": [{"cube": {}}])",
         "colliders[0].cube: unknown key, expected one of motion, sphere, plane, capsule"},
        {R"("colliders": [{"motion": {"translate": {}}}])",
         "colliders[0]: is missing what it is, expected one of sphere, plane, capsule"},
        {R"("colliders": [{"sphere": {}, "motion": {"rotate": {"axis": [0, 0, 0]}}}])",
         "colliders[0].motion.rotate.axis: expected an axis of any length but 0"},
        {R"("colliders": [{"sphere": {}, "motion": {"slide": {}}}])",
         "colliders[0].motion.slide: unknown key, expected"},
        {R"("colliders": [{"sphere": {"radius": 0}}])", "colliders[0].sphere.radius: expected a number > 0, got 0"},
    }));
    CAPTURE(rest);
    CHECK_THAT(error_of(R"({"mesh": {"grid": {}}, )" + rest + "}"), Catch::StartsWith("folder/scene.json: " + message));
}

TEST_CASE("what is wrong with a mesh is named by its path") {
    const auto [mesh, message] = GENERATE(table<std::string, std::string>({
        {R"({})", "mesh: is missing what it is, expected one of grid, tube, file"},
        {R"({"grid": {}, "file": "x.obj"})", "mesh: has both grid and file"},
        {R"({"grid": {}, "height": 1})", "mesh.height: only a mesh from a file is scaled to a height"},
        {R"({"grid": {"vertices": [1, 5]}})", "mesh.grid.vertices[0]: expected a whole number from 2"},
        {R"({"grid": {"vertices": [5]}})", "mesh.grid.vertices: expected two whole numbers, got [5]"},
        {R"({"grid": {"vertices": [1000000, 1000000]}})", "mesh.grid: more than"},
        {R"({"grid": {"size": [1, 0]}})", "mesh.grid.size[1]: expected a number > 0, got 0"},
        {R"({"grid": {"jitter": 1}})", "mesh.grid.jitter: expected a number ≥ 0 and < 1, got 1"},
        {R"({"grid": {"diagonals": "zigzag"}})",
         "mesh.grid.diagonals: expected one of uniform, alternating, random, got \"zigzag\""},
        {R"({"tube": {"segments": [2, 4]}})", "mesh.tube.segments[0]: expected a whole number from 3"},
        {R"({"tube": {"radius": [0.1, -0.1]}})", "mesh.tube.radius[1]: expected a number > 0"},
        {R"({"file": ""})", "mesh.file: expected the name of a file, got \"\""},
        {R"({"file": "\u0000x.obj"})", "mesh.file: expected the name of a file, got \"\\u0000x.obj\""},
        {R"({"file": 3})", "mesh.file: expected a text, got 3"},
        {R"({"grid": {}, "weld": 1})", "mesh.weld: only a mesh from a file is welded"},
        {R"({"file": "x.obj", "weld": -1})", "mesh.weld: expected a number ≥ 0, got -1"},
        {R"({"file": "x.obj", "height": 0})", "mesh.height: expected a number > 0, got 0"},
    }));
    CAPTURE(mesh);
    CHECK_THAT(error_of(R"({"mesh": )" + mesh + "}"), Catch::StartsWith("folder/scene.json: " + message));
}

TEST_CASE("a scene without a mesh, and one that is no object") {
    CHECK(error_of("{}") == "folder/scene.json: mesh is missing, expected one of grid, tube, file in it");
    CHECK(error_of("[]") == "folder/scene.json: expected an object, got []");
}

TEST_CASE("a scene file that is missing or no JSON") {
    const TemporaryFolder folder;
    const std::string missing = (folder.path() / "missing.json").string();
    CHECK(input_error_of([&] { read_scene(missing); }) == missing + ": no such scene file");
    const std::string broken = folder.write("broken.json", "{\n \"mesh\": {\"grid\": {}},\n \"frames\": }\n");
    CHECK_THAT(input_error_of([&] { read_scene(broken); }),
               Catch::StartsWith(broken + ": not valid JSON: parse error at line 3, column"));
    const std::string huge = folder.write("huge.json", R"({"mesh": {"grid": {}}, "density": 1e999})");
    CHECK_THAT(input_error_of([&] { read_scene(huge); }), Catch::StartsWith(huge + ": not valid JSON: "));
}
