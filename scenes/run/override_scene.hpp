// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace apsl::scenes {

/// Changes one value of a scene: "strain_limiting.regularization=1.05", "pins[0].motion.rotate.degrees_per_second=30".
/// Missing objects on the way are made; an array takes an index up to its size. The value is JSON, or else text; null
/// takes a key out, but no entry of an array: false where there is no such key. Naming one kind of mesh or integrator
/// puts it in place of the other kinds. A mesh file given here is relative to the working directory, as everything else
/// on a command line is. Throws InputError where there is no "=", or where the path runs through something that has no
/// such entry; a list that is not given is given as a whole. Instantiated for nlohmann::json and
/// nlohmann::ordered_json.
template <class Json>
bool override_scene(Json& document, const std::string& assignment);

/// One change after the other, as --set has them on a command line. Warns, on standard error, of a key to take out that
/// is not there.
template <class Json>
void override_scene(Json& document, std::span<const std::string> assignments);

}  // namespace apsl::scenes
