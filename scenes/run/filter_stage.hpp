// SPDX-License-Identifier: MIT
#pragma once

#include "run/bending_iterations.hpp"
#include "run/custom_filter.hpp"
#include "run/custom_step.hpp"
#include "run/float_range.hpp"
#include "run/input_error.hpp"
#include "run/opencl_filter.hpp"
#include "run/opencl_step.hpp"
#include "run/reference_filter.hpp"
#include "run/reference_step.hpp"
#include "run/scene_tethers.hpp"

#include <optional>
#include <string>
#include <variant>

namespace apsl::scenes {

enum class Backend { opencl, reference };

/// The strain limiting of a scene, a step where it is stand-alone, or std::monostate where the scene names none: then
/// no device is looked for. No scene asks for a CustomFilter or CustomStep: who compares puts one in place.
using FilterStage =
    std::variant<std::monostate, OpenClFilter, ReferenceFilter, OpenClStep, ReferenceStep, CustomFilter, CustomStep>;

/// What is on an OpenCL device, or null.
inline OpenClCloth* on_device(FilterStage& stage) {
    if (auto* filter = std::get_if<OpenClFilter>(&stage)) return &filter->device();
    if (auto* step = std::get_if<OpenClStep>(&stage)) return &step->device();
    return nullptr;
}

/// Whether collision response has nothing left to do: contact is kept in the call.
inline bool keeps_contacts(const FilterStage& stage) {
    if (const auto* filter = std::get_if<OpenClFilter>(&stage)) return filter->keeps_contacts();
    if (const auto* filter = std::get_if<ReferenceFilter>(&stage)) return filter->keeps_contacts();
    return false;
}

/// The scene's strain limiting for its cloth: with contact in the call where a stretch ceiling would otherwise be lost
/// to it, with as many evaluations of bending as the mesh needs, and with a tether to each of a few pinned pieces.
inline StrainLimiting limiting_of(const Scene& scene, const ClothState& cloth) {
    StrainLimiting limiting = scene.strain_limiting.value();
    if (limiting.options.bends) limiting.parameters.bending_iterations = bending_iterations(cloth, limiting.parameters);
    if (limiting.tethers > 0.0f) limiting.options.tethers_per_vertex = tethers_per_vertex(cloth);
    const Parameters& parameters = limiting.parameters;
    if (limiting.options.limits_stretch && parameters.stepping != Stepping::whole_step && parameters.sub_steps >= 2)
        limiting.options.keeps_contacts = !scene.colliders.empty();
    return limiting;
}

/// `device`: set for Backend::opencl. Throws InputError for a cloth that a device cannot hold.
inline FilterStage make_filter_stage(const Scene& scene, const ClothState& cloth, Backend backend,
                                     const std::optional<OpenClDevice>& device, bool profile) {
    if (!scene.strain_limiting) return std::monostate{};
    if (backend == Backend::opencl)
        if (const auto text = beyond_float_range(cloth)) throw InputError(scene.file + ": " + *text);
    const StrainLimiting limiting = limiting_of(scene, cloth);
    const bool whole_step = limiting.options.integrates;
    if (backend == Backend::reference) {
        if (whole_step) return ReferenceStep(cloth, limiting);
        return ReferenceFilter(cloth, limiting);
    }
    if (whole_step) return OpenClStep(device.value(), cloth, limiting, profile);
    return OpenClFilter(device.value(), cloth, limiting, profile);
}

}  // namespace apsl::scenes
