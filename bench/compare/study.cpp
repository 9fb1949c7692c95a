// SPDX-License-Identifier: MIT
#include "compare/study.hpp"

#include "run/input_error.hpp"
#include "run/override_scene.hpp"
#include "run/parse_scene.hpp"
#include "run/scene_object.hpp"

#include <algorithm>
#include <fstream>
#include <limits>

namespace apsl::compare {
namespace {

using scenes::InputError;
using scenes::Range;
using scenes::SceneObject;
using scenes::SceneValue;

constexpr std::int64_t max_count = std::numeric_limits<std::int32_t>::max();

SceneCase as_case(std::string name, const std::filesystem::path& file, nlohmann::json document) {
    (void)scenes::parse_scene(document, file.string());  // wrong values should be known before anything runs
    return {.name = std::move(name), .file = file.string(), .document = std::move(document)};
}

SceneCase parse_case(const SceneValue& value, const std::filesystem::path& folder,
                     const std::vector<std::string>& overrides) {
    SceneObject object(value);
    if (!object.has("file")) value.fail("file is missing, expected a scene file");
    const std::filesystem::path file = (folder / object.find("file").text()).lexically_normal();
    const std::string name = object.has("name") ? object.find("name").text() : file.stem().string();
    nlohmann::json document = scenes::read_scene_document(file);
    if (const SceneValue changes = object.find("set"); changes.json != nullptr) {
        if (!changes.json->is_object()) changes.expected("an object of scene paths and values");
        for (const auto& [path, changed] : changes.json->items()) {
            nlohmann::json to = changed;
            if (path == "mesh.file" && to.is_string())
                to = std::filesystem::absolute(folder / to.get<std::string>()).string();
            scenes::override_scene(document, path + "=" + to.dump());
        }
    }
    object.refuse_other_keys();
    scenes::override_scene(document, overrides);
    return as_case(name, file, std::move(document));
}

MethodRuns parse_method(const SceneValue& value) {
    if (value.json->is_string()) {
        const std::string name = value.text();  // named: the reference to a method is not one to its name
        const ComparedMethod& method = find_method(name);
        return {.method = &method, .parameters = standard_sweep(method)};
    }
    SceneObject object(value);
    if (!object.has("name")) value.fail("name is missing, expected a method's");
    const std::string name = object.find("name").text();
    const ComparedMethod& method = find_method(name);
    MethodRuns runs{.method = &method, .parameters = {}};
    const SceneValue parameters = object.find("parameters");
    object.refuse_other_keys();
    if (parameters.json == nullptr) {
        runs.parameters = standard_sweep(method);
        return runs;
    }
    if (!parameters.json->is_object())
        parameters.expected("an object of parameters with a value or a list of values each");
    runs.parameters = combinations(ParameterValues(*parameters.json));
    try {
        for (const ParameterValues& combination : runs.parameters) check_parameters(method, combination);
    } catch (const InputError& error) {
        parameters.fail(error.what());
    }
    return runs;
}

DeviationSettings parse_deviation(SceneObject object) {
    DeviationSettings settings;
    ConvergedSettings& converged = settings.converged;
    if (const SceneValue frames = object.find("frames"); frames.json != nullptr)
        for (const SceneValue& frame : frames.entries())
            settings.frames.push_back(static_cast<int>(frame.integer(0, max_count)));
    converged.step_factor = static_cast<int>(object.integer("step_factor", converged.step_factor, 1, 10'000));
    converged.sub_steps = static_cast<int>(object.integer("sub_steps", converged.sub_steps, 0, max_count));
    converged.regularization = object.number("regularization", converged.regularization, Range::at_least(1.0));
    converged.tolerance = object.number("tolerance", converged.tolerance, Range::from_to_below(0.0, 1.0));
    converged.target_area_change =
        object.number("target_area_change", converged.target_area_change, Range::at_least(0.0));
    object.refuse_other_keys();
    return settings;
}

nlohmann::json read_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!std::filesystem::is_regular_file(file) || !stream) throw InputError(file.string() + ": no such study file");
    nlohmann::json document = nlohmann::json::parse(stream, nullptr, false);
    if (document.is_discarded()) throw InputError(file.string() + ": not valid JSON");
    return document;
}

}  // namespace

SceneCase read_scene_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return as_case(file.stem().string(), file, nlohmann::json(scenes::read_scene_document(file, overrides)));
}

Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    const nlohmann::json document = read_json(file);
    SceneObject object({&document, file.string(), ""});
    Study study;
    if (object.has("scenes"))
        for (const SceneValue& scene : object.find("scenes").entries())
            study.scenes.push_back(parse_case(scene, file.parent_path(), overrides));
    if (object.has("methods"))
        for (const SceneValue& method : object.find("methods").entries()) study.methods.push_back(parse_method(method));
    if (object.has("deviation")) study.deviation = parse_deviation(SceneObject(object.find("deviation")));
    if (object.has("run_seconds")) study.run_seconds = object.find("run_seconds").number(Range::above(0.0));
    study.rounds = static_cast<int>(object.integer("rounds", study.rounds, 1, max_rounds));
    if (const SceneValue keep = object.find("keep_frames"); keep.json != nullptr) {
        if (!keep.json->is_boolean()) keep.expected("true or false");
        study.keep_frames = keep.json->get<bool>();
    }
    object.refuse_other_keys();
    return study;
}

std::vector<MethodRuns> standard_methods(const std::vector<std::string>& names) {
    std::vector<MethodRuns> runs;
    if (names.empty())
        for (const ComparedMethod& method : compared_methods()) runs.push_back({&method, standard_sweep(method)});
    for (const std::string& name : names) {
        const ComparedMethod& method = find_method(name);
        runs.push_back({&method, standard_sweep(method)});
    }
    return runs;
}

}  // namespace apsl::compare
