// SPDX-License-Identifier: MIT
#include "run/parse_scene.hpp"

#include "fields.hpp"
#include "run/input_error.hpp"
#include "run/override_scene.hpp"
#include "run/parse_json.hpp"
#include "run/parse_vertices.hpp"
#include "run/read_file.hpp"
#include "run/scene_object.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>
#include <type_traits>

namespace apsl::scenes {
namespace {

constexpr std::int64_t max_count = std::numeric_limits<std::int32_t>::max();
// Shorter ones would draw a cloth into its pins.
constexpr double least_tethers = 0.01;

// As the limiter has it. `given`: where the scene says it.
float in_32_bits(double number, const SceneValue& given) {
    const auto held = static_cast<float>(number);
    if (!std::isfinite(held)) given.expected("a number that 32 bits hold, at most 3.4e38");
    return held;
}

std::array<std::uint32_t, 2> counts(SceneObject& object, const std::string& key,
                                    const std::array<std::uint32_t, 2>& fallback,
                                    const std::array<std::int64_t, 2>& min) {
    const SceneValue value = object.find(key);
    if (value.json == nullptr) return fallback;
    const std::vector<SceneValue> entries = value.entries();
    if (entries.size() != 2) value.expected("two whole numbers");
    // A million each way is beyond what 32-bit corner numbers can hold, together they are checked by the topology.
    return {static_cast<std::uint32_t>(entries[0].integer(min[0], 1'000'000)),
            static_cast<std::uint32_t>(entries[1].integer(min[1], 1'000'000))};
}

std::array<double, 2> positive_pair(SceneObject& object, const std::string& key,
                                    const std::array<double, 2>& fallback) {
    const SceneValue value = object.find(key);
    if (value.json == nullptr) return fallback;
    const std::vector<SceneValue> entries = value.entries();
    if (entries.size() != 2) value.expected("two numbers");
    return {entries[0].number(Range::above(0.0)), entries[1].number(Range::above(0.0))};
}

Diagonals parse_diagonals(SceneObject& object, Diagonals fallback) {
    return object.choice(
        "diagonals", fallback,
        {{"uniform", Diagonals::uniform}, {"alternating", Diagonals::alternating}, {"random", Diagonals::random}});
}

// Corners of triangles are numbered in 32 bits (Topology::build).
void check_triangle_count(const SceneObject& object, double cells) {
    if (2.0 * cells * 3.0 >= 0x1p32) object.value().fail("more than 2³² / 3 triangles");
}

GridMesh parse_grid(SceneObject object) {
    GridMesh grid;
    grid.vertices = counts(object, "vertices", grid.vertices, {2, 2});
    grid.size = positive_pair(object, "size", grid.size);
    grid.diagonals = parse_diagonals(object, grid.diagonals);
    grid.jitter = object.number("jitter", grid.jitter, Range::from_to_below(0.0, 1.0));
    grid.plane =
        object.choice("plane", grid.plane, {{"horizontal", GridPlane::horizontal}, {"vertical", GridPlane::vertical}});
    object.refuse_other_keys();
    check_triangle_count(object, (grid.vertices[0] - 1.0) * (grid.vertices[1] - 1.0));
    return grid;
}

TubeMesh parse_tube(SceneObject object) {
    TubeMesh tube;
    tube.radius = positive_pair(object, "radius", tube.radius);
    tube.height = object.number("height", tube.height, Range::above(0.0));
    tube.segments = counts(object, "segments", tube.segments, {3, 1});
    tube.diagonals = parse_diagonals(object, tube.diagonals);
    tube.jitter = object.number("jitter", tube.jitter, Range::from_to_below(0.0, 1.0));
    object.refuse_other_keys();
    check_triangle_count(object, 1.0 * tube.segments[0] * tube.segments[1]);
    return tube;
}

MeshSource parse_mesh(SceneObject object, const std::filesystem::path& folder) {
    MeshFile source;
    const SceneValue file = object.find("file");
    const SceneValue height = object.find("height");
    const SceneValue weld = object.find("weld");
    const std::string kind = object.only_one_of({"grid", "tube", "file"});
    if (height.json != nullptr && kind != "file") height.fail("only a mesh from a file is scaled to a height");
    if (weld.json != nullptr && kind != "file") weld.fail("only a mesh from a file is welded");
    if (kind == "grid") return parse_grid(SceneObject(object.find("grid")));
    if (kind == "tube") return parse_tube(SceneObject(object.find("tube")));
    const std::string name = file.text();
    if (name.empty() || name.find('\0') != std::string::npos) file.expected("the name of a file");
    source.file = folder / name;
    if (height.json != nullptr) source.height = height.number(Range::above(0.0));
    if (weld.json != nullptr) source.weld = weld.number(Range::at_least(0.0));
    return source;
}

Start parse_start(SceneObject object) {
    Start start;
    start.scale = object.vector3("scale", start.scale);
    start.random = object.number("random", start.random, Range::at_least(0.0));
    start.rest_areas = object.number("rest_areas", start.rest_areas, Range::above(0.0));
    object.refuse_other_keys();
    return start;
}

Integrator parse_integrator(SceneObject object) {
    const std::string kind = object.only_one_of({"implicit_springs", "bending_springs", "stand_alone", "none"});
    SceneObject settings(object.find(kind));
    Integrator integrator;
    if (kind == "implicit_springs") {
        ImplicitSpringsIntegrator springs;
        springs.stretch_stiffness =
            settings.number("stretch_stiffness", springs.stretch_stiffness, Range::at_least(0.0));
        springs.bend_stiffness = settings.number("bend_stiffness", springs.bend_stiffness, Range::at_least(0.0));
        springs.damping = settings.number("damping", springs.damping, Range::at_least(0.0));
        integrator = springs;
    } else if (kind == "bending_springs") {
        BendingSpringsIntegrator springs;
        springs.bend_stiffness = settings.number("bend_stiffness", springs.bend_stiffness, Range::at_least(0.0));
        springs.damping = settings.number("damping", springs.damping, Range::at_least(0.0));
        integrator = springs;
    } else if (kind == "stand_alone") {
        StandAloneIntegrator stand_alone;
        stand_alone.damping = settings.number("damping", stand_alone.damping, Range::at_least(0.0));
        stand_alone.bending = settings.number("bending", stand_alone.bending, Range::at_least(0.0));
        stand_alone.tethers = settings.number("tethers", stand_alone.tethers, Range{.min = 0.0, .max = 1e6});
        if (stand_alone.tethers > 0.0 && stand_alone.tethers < least_tethers)
            settings.find("tethers").expected("0 (none) or a number ≥ 0.01");
        // What it had before, and no key of it now.
        if (settings.value().json->contains("bend_stiffness"))
            SceneObject(settings.value())
                .find("bend_stiffness")
                .fail(
                    "a stand-alone cloth has no springs, expected bending (N·m); those in front of the filter are "
                    "integrator.bending_springs");
        integrator = stand_alone;
    }
    settings.refuse_other_keys();
    return integrator;
}

Range range_of(const Bounds& bounds) {
    // Where 0 is legal beside a range, validate() tells.
    return {.min = bounds.zero ? 0.0 : bounds.least,
            .min_excluded = bounds.least_excluded && !bounds.zero,
            .max = bounds.greatest,
            .max_excluded = bounds.greatest_excluded};
}

template <class Struct, class Value>
void parse_field(SceneObject& object, const Field<Struct, Value>& field, Struct& values) {
    if (!field.in_scenes) return;
    Value& value = values.*field.member;
    if constexpr (is_vector<Value>) {
        object.value().fail("strain_limiting has no vectors");
    } else if constexpr (std::is_enum_v<Value>) {
        std::array<std::pair<const char*, Value>, names_of<Value>.size()> choices;
        std::ranges::transform(names_of<Value>, choices.begin(),
                               [](const auto& named) { return std::pair(named.second, named.first); });
        value = object.choice(field.name, value, choices);
    } else if constexpr (std::is_floating_point_v<Value>) {
        const double number = object.number(field.name, value, range_of(field.bounds));
        value = in_32_bits(number, object.find(field.name));
    } else {
        const auto least = static_cast<std::int64_t>(field.bounds.least);
        const auto greatest = static_cast<std::int64_t>(std::min(field.bounds.greatest, double{max_count}));
        value = static_cast<Value>(object.integer(field.name, value, least, greatest));
    }
}

// One for all triangles into `uniform`, or one for each into `each`.
void parse_triangle_values(SceneObject& object, const Field<Parameters, float>& field, Parameters& uniform,
                           std::vector<float>& each) {
    const SceneValue given = object.find(field.name);
    if (given.json == nullptr || !given.json->is_array()) return parse_field(object, field, uniform);
    if (given.json->empty()) given.expected("a number, or one for each triangle");
    for (const SceneValue& entry : given.entries()) {
        each.push_back(in_32_bits(entry.number(range_of(field.bounds)), entry));
        // Only of a field that may be 0.
        if (!field.bounds.hold(each.back())) {
            std::ostringstream text;
            text << "0 or a number ≥ " << field.bounds.least;
            entry.expected(text.str());
        }
    }
}

StrainLimiting parse_strain_limiting(SceneObject object, float time_step) {
    StrainLimiting settings;
    for_each_field(option_fields, [&](const auto& field) { parse_field(object, field, settings.options); });
    for_each_field(parameter_fields, [&](const auto& field) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, Field<Parameters, float>>)
            if (field.may_be_a_list)
                return parse_triangle_values(
                    object, field, settings.parameters,
                    field.member == &Parameters::regularization ? settings.regularization : settings.stretch_ceilings);
        parse_field(object, field, settings.parameters);
    });
    settings.options.regularization_per_triangle = !settings.regularization.empty();
    // A list in which no triangle has a ceiling is areas alone, as 0 is.
    settings.options.stretch_ceiling_per_triangle =
        std::ranges::any_of(settings.stretch_ceilings, [](float ceiling) { return ceiling > 0.0f; });
    settings.options.limits_stretch =
        settings.parameters.stretch_ceiling > 0.0f || settings.options.stretch_ceiling_per_triangle;
    settings.parameters.time_step = time_step;
    object.refuse_other_keys();
    try {
        validate(settings.options, settings.parameters);  // of the numbers, what 32-bit floats make of them
    } catch (const Error& error) {
        object.value().fail(error.what());
    }
    return settings;
}

float held_time_step(SceneObject& object, double time_step) {
    const SceneValue given = object.find("time_step");
    const float held = in_32_bits(time_step, given);
    if (held == 0.0f) given.expected("a number > 0 that 32 bits hold, at least 1.2e-38");
    return held;
}

// Options and parameters of whole steps.
void make_stand_alone(Scene& scene, SceneObject& object) {
    const auto* stand_alone = std::get_if<StandAloneIntegrator>(&scene.integrator);
    if (stand_alone == nullptr) return;
    SceneObject integrator(object.find("integrator"));
    SceneObject settings(integrator.find("stand_alone"));
    if (!scene.strain_limiting)
        integrator.value().fail("stand_alone is a step of the limiter, expected strain_limiting beside it");
    StrainLimiting& limiting = *scene.strain_limiting;
    limiting.options.integrates = true;
    limiting.options.keeps_contacts = !scene.colliders.empty();
    if (const SceneValue gravity = object.find("gravity"); gravity.json != nullptr)
        for (const SceneValue& number : gravity.entries()) in_32_bits(number.number(), number);
    for (std::size_t k = 0; k < 3; ++k) limiting.parameters.acceleration[k] = static_cast<float>(scene.gravity[k]);
    limiting.parameters.damping = in_32_bits(stand_alone->damping, settings.find("damping"));
    limiting.parameters.bending = in_32_bits(stand_alone->bending, settings.find("bending"));
    limiting.options.bends = stand_alone->bending > 0.0;
    limiting.tethers = static_cast<float>(stand_alone->tethers);
    try {
        validate(limiting.options, limiting.parameters);
    } catch (const Error& error) {
        integrator.value().fail(std::string("stand_alone: ") + error.what());
    }
}

Contact parse_contact(SceneObject& object) {
    Contact contact;
    contact.friction = object.number("friction", contact.friction, Range::at_least(0.0));
    contact.thickness = object.number("thickness", contact.thickness, Range::at_least(0.0));
    return contact;
}

MovingCollider parse_collider(SceneObject object) {
    MovingCollider moving;
    if (object.has("motion")) moving.motion = parse_motion(SceneObject(object.find("motion")));
    const std::string kind = object.only_one_of({"sphere", "plane", "capsule"});
    SceneObject shape(object.find(kind));
    Collider collider;
    if (kind == "sphere") {
        Sphere sphere;
        sphere.center = shape.vector3("center", sphere.center);
        sphere.radius = shape.number("radius", 0.3, Range::above(0.0));
        sphere.contact = parse_contact(shape);
        collider = sphere;
    } else if (kind == "plane") {
        Plane plane;
        plane.point = shape.vector3("point", plane.point);
        plane.normal = shape.vector3("normal", plane.normal);
        plane.contact = parse_contact(shape);
        collider = plane;
    } else {
        Capsule capsule;
        capsule.a = shape.vector3("a", {-0.3, 0.0, 0.0});
        capsule.b = shape.vector3("b", {0.3, 0.0, 0.0});
        capsule.radius = shape.number("radius", 0.1, Range::above(0.0));
        capsule.contact = parse_contact(shape);
        collider = capsule;
    }
    shape.refuse_other_keys();
    try {
        validate(collider);
    } catch (const Error& error) {
        shape.value().fail(error.what());
    }
    moving.shape = collider;
    return moving;
}

}  // namespace

Scene parse_scene(const nlohmann::json& document, const std::string& file) {
    SceneObject object({&document, file, ""});
    Scene scene;
    scene.file = file;
    if (!object.has("mesh")) object.value().fail("mesh is missing, expected one of grid, tube, file in it");
    scene.mesh = parse_mesh(SceneObject(object.find("mesh")), std::filesystem::path(file).parent_path());
    scene.density = object.number("density", scene.density, Range::above(0.0));
    if (object.has("pins"))
        for (const SceneValue& pin : object.find("pins").entries()) scene.pins.push_back(parse_pin(SceneObject(pin)));
    if (object.has("masses"))
        for (const SceneValue& masses : object.find("masses").entries())
            scene.masses.push_back(parse_mass_factor(SceneObject(masses)));
    if (object.has("start")) scene.start = parse_start(SceneObject(object.find("start")));
    scene.gravity = object.vector3("gravity", scene.gravity);
    scene.time_step = object.number("time_step", scene.time_step, Range::above(0.0));
    scene.steps_per_frame = static_cast<int>(object.integer("steps_per_frame", scene.steps_per_frame, 1, max_count));
    scene.frames = static_cast<int>(object.integer("frames", scene.frames, 1, max_count));
    if (object.has("integrator")) scene.integrator = parse_integrator(SceneObject(object.find("integrator")));
    // null, as --set writes it, is none.
    if (const SceneValue limiting = object.find("strain_limiting"); limiting.json && !limiting.json->is_null())
        scene.strain_limiting = parse_strain_limiting(SceneObject(limiting), held_time_step(object, scene.time_step));
    if (object.has("colliders"))
        for (const SceneValue& collider : object.find("colliders").entries())
            scene.colliders.push_back(parse_collider(SceneObject(collider)));
    make_stand_alone(scene, object);
    object.refuse_other_keys();
    return scene;
}

nlohmann::ordered_json read_scene_document(const std::filesystem::path& file, std::span<const std::string> overrides) {
    const std::string text = read_file(file, "scene");
    nlohmann::ordered_json document = parse_json(text, file.string());
    override_scene(document, overrides);
    return document;
}

Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides) {
    return parse_scene(nlohmann::json(read_scene_document(file, overrides)), file.string());
}

}  // namespace apsl::scenes
