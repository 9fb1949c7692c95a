// SPDX-License-Identifier: MIT
#pragma once

#include "run/custom_filter.hpp"
#include "run/float_range.hpp"
#include "run/input_error.hpp"
#include "run/opencl_filter.hpp"
#include "run/opencl_step.hpp"
#include "run/reference_filter.hpp"
#include "run/reference_step.hpp"

#include <optional>
#include <string>
#include <variant>

namespace apsl::scenes {

enum class Backend { opencl, reference };

/// The strain limiting of a scene, a step where it is stand-alone, or std::monostate where the scene names none: then
/// no device is looked for. No scene asks for a CustomFilter: who compares limiters puts one in place.
using FilterStage =
    std::variant<std::monostate, OpenClFilter, ReferenceFilter, OpenClStep, ReferenceStep, CustomFilter>;

/// What is on an OpenCL device, or null.
inline OpenClCloth* on_device(FilterStage& stage) {
    if (auto* filter = std::get_if<OpenClFilter>(&stage)) return &filter->device();
    if (auto* step = std::get_if<OpenClStep>(&stage)) return &step->device();
    return nullptr;
}

/// `device`: set for Backend::opencl. Throws InputError for a cloth that a device cannot hold.
inline FilterStage make_filter_stage(const Scene& scene, const ClothState& cloth, Backend backend,
                                     const std::optional<OpenClDevice>& device, bool profile) {
    if (!scene.strain_limiting) return std::monostate{};
    if (backend == Backend::opencl)
        if (const auto text = beyond_float_range(cloth)) throw InputError(scene.file + ": " + *text);
    const bool whole_step = scene.strain_limiting->options.integrates;
    if (backend == Backend::reference) {
        if (whole_step) return ReferenceStep(cloth, *scene.strain_limiting);
        return ReferenceFilter(cloth, *scene.strain_limiting);
    }
    if (whole_step) return OpenClStep(device.value(), cloth, *scene.strain_limiting, profile);
    return OpenClFilter(device.value(), cloth, *scene.strain_limiting, profile);
}

}  // namespace apsl::scenes
