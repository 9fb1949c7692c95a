// SPDX-License-Identifier: MIT
#pragma once

#include "run/custom_filter.hpp"
#include "run/float_range.hpp"
#include "run/input_error.hpp"
#include "run/opencl_filter.hpp"
#include "run/reference_filter.hpp"

#include <optional>
#include <string>
#include <variant>

namespace apsl::scenes {

enum class Backend { opencl, reference };

/// The strain limiting of a scene, or std::monostate where the scene names none: then no device is looked for. No scene
/// asks for a CustomFilter: who compares limiters puts one in place.
using FilterStage = std::variant<std::monostate, OpenClFilter, ReferenceFilter, CustomFilter>;

/// `device`: set for Backend::opencl. Throws InputError for a cloth that a device cannot hold.
inline FilterStage make_filter_stage(const Scene& scene, const ClothState& cloth, Backend backend,
                                     const std::optional<OpenClDevice>& device, bool profile) {
    if (!scene.strain_limiting) return std::monostate{};
    if (backend == Backend::opencl)
        if (const auto text = beyond_float_range(cloth)) throw InputError(scene.file + ": " + *text);
    if (backend == Backend::reference) return ReferenceFilter(cloth, *scene.strain_limiting);
    return OpenClFilter(device.value(), cloth, *scene.strain_limiting, profile);
}

}  // namespace apsl::scenes
