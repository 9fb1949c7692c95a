// SPDX-License-Identifier: MIT
#include "compare/compared_methods.hpp"
#include "run/input_error.hpp"
#include "run/override_scene.hpp"
#include "run/scene_document.hpp"

#include <cmath>

namespace apsl::compare {
namespace {

using scenes::InputError;

// Whole numbers as such: a scene has counts, and 10.0 is not how anyone writes one.
nlohmann::json tidy(const nlohmann::json& value) {
    if (!value.is_number_float()) return value;
    const double number = value.get<double>();
    if (number == std::floor(number) && std::abs(number) < 1e15) return static_cast<std::int64_t>(number);
    return value;
}

void set(nlohmann::json& document, const std::string& path, const nlohmann::json& value) {
    scenes::override_scene(document, path + "=" + value.dump());
}

void fill_in_limiting(nlohmann::json& document) {
    const Parameters standard;
    nlohmann::json& limiting = document["strain_limiting"];
    if (limiting.is_null()) limiting = nlohmann::json::object();
    const auto fill_in = [&](const char* key, const nlohmann::json& value) {
        if (limiting.is_object() && !limiting.contains(key)) limiting[key] = value;
    };
    fill_in("sub_steps", standard.sub_steps);
    fill_in("regularization", scenes::shortest(standard.regularization));
    fill_in("tolerance", scenes::shortest(standard.tolerance));
    fill_in("max_iterations", standard.max_iterations);
}

void stiffen_springs(nlohmann::json& document, const std::string& file, double factor) {
    if (!document.contains("integrator") || !document["integrator"].contains("implicit_springs"))
        throw InputError(file + ": springs: expected a scene whose integrator is implicit_springs");
    nlohmann::json& springs = document["integrator"]["implicit_springs"];
    const scenes::ImplicitSpringsIntegrator standard;
    springs["stretch_stiffness"] = factor * springs.value("stretch_stiffness", standard.stretch_stiffness);
}

bool takes_whole_steps(const nlohmann::json& document) {
    const auto integrator = document.find("integrator");
    return integrator != document.end() && integrator->contains("stand_alone");
}

nlohmann::json value_at(const nlohmann::json& document, const std::string& path) {
    const nlohmann::json* place = &document;
    for (std::size_t first = 0; first < path.size();) {
        const std::size_t end = std::min(path.find('.', first), path.size());
        const auto found = place->find(path.substr(first, end - first));
        if (found == place->end()) return nullptr;
        place = &*found;
        first = end + 1;
    }
    return *place;
}

}  // namespace

PreparedScene prepare_scene(const ComparedMethod& method, const nlohmann::json& document, const std::string& file,
                            const ParameterValues& parameters) {
    check_parameters(method, parameters);
    const bool integrates = method.kind == MethodKind::tethers || method.kind == MethodKind::small_steps;
    if (integrates && document.contains("colliders") && !document["colliders"].empty())
        throw InputError(file + ": " + method.name + ": expected a scene without colliders");
    if (method.kind != MethodKind::ours && !integrates && takes_whole_steps(document))
        throw InputError(file + ": " + method.name +
                         ": expected a scene whose integrator is not stand_alone: that is a step of our limiter");
    PreparedScene prepared{.document = document, .parameters = ParameterValues::object()};
    const bool ours = method.kind == MethodKind::ours || method.kind == MethodKind::direct;
    if (ours) {
        fill_in_limiting(prepared.document);
        for (const auto& [path, value] : method.settings) set(prepared.document, path, value);
    } else {
        prepared.document.erase("strain_limiting");
        if (integrates) prepared.document["integrator"] = {{"none", nlohmann::json::object()}};
    }
    // Those given first to last, and before them the standard ones.
    ParameterValues values = ParameterValues::object();
    for (const MethodParameter& parameter : method.parameters)
        if (parameter.standard) values[parameter.name] = *parameter.standard;
    for (const auto& [name, value] : parameters.items()) values[name] = value;
    for (const auto& [name, given] : values.items()) {
        const nlohmann::json value = tidy(given);
        if (name == "steps_per_frame") {
            if (!value.is_number_integer()) throw InputError(method.name + ": steps_per_frame must be whole");
            scenes::set_steps_per_frame(prepared.document, value.get<std::int64_t>());
        } else if (method.kind == MethodKind::springs) {
            stiffen_springs(prepared.document, file, value.get<double>());
        } else if (ours) {
            set(prepared.document, name, value);
        }
        prepared.parameters[name] = value;
    }
    for (const MethodParameter& parameter : method.parameters)
        if (!prepared.parameters.contains(parameter.name))
            prepared.parameters[parameter.name] = value_at(prepared.document, parameter.name);
    prepared.parameters["steps_per_frame"] = prepared.document.value("steps_per_frame", 1);
    return prepared;
}

}  // namespace apsl::compare
