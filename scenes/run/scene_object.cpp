// SPDX-License-Identifier: MIT
#include "run/scene_object.hpp"

#include "run/input_error.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::scenes {
namespace {

std::string shown(const nlohmann::json& value) {
    const std::string text = value.dump();
    return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

std::string shown(double value) {
    return nlohmann::json(value).dump();
}

// Whole limits without their ".0".
std::string limit(double value) {
    return value == std::floor(value) && std::abs(value) < 1e15 ? std::to_string(static_cast<std::int64_t>(value))
                                                                : shown(value);
}

std::string described(const Range& range) {
    std::string text;
    if (std::isfinite(range.min)) text += (range.min_excluded ? " > " : " ≥ ") + limit(range.min);
    if (std::isfinite(range.max))
        text += (text.empty() ? "" : " and") + std::string(range.max_excluded ? " < " : " ≤ ") + limit(range.max);
    return text;
}

std::string key_path(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
}

}  // namespace

void SceneValue::fail(const std::string& what_was_wrong) const {
    throw InputError(file + ": " + (path.empty() ? "" : path + ": ") + what_was_wrong);
}

void SceneValue::expected(const std::string& what) const {
    fail("expected " + what + ", got " + shown(*json));
}

double SceneValue::number(const Range& range) const {
    const double value = json->is_number() ? json->get<double>() : std::numeric_limits<double>::quiet_NaN();
    const bool above_min = range.min_excluded ? value > range.min : value >= range.min;
    const bool below_max = range.max_excluded ? value < range.max : value <= range.max;
    if (!std::isfinite(value) || !above_min || !below_max) expected("a number" + described(range));
    return value;
}

std::int64_t SceneValue::integer(std::int64_t min, std::int64_t max) const {
    const double value = json->is_number() ? json->get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!(value == std::floor(value)) || value < static_cast<double>(min) || value > static_cast<double>(max))
        expected("a whole number from " + std::to_string(min) + " to " + std::to_string(max));
    return static_cast<std::int64_t>(value);
}

std::string SceneValue::text() const {
    if (!json->is_string()) expected("a text");
    return json->get<std::string>();
}

std::array<double, 3> SceneValue::vector3() const {
    if (!json->is_array() || json->size() != 3) expected("three numbers");
    const std::vector<SceneValue> values = entries();
    return {values[0].number(), values[1].number(), values[2].number()};
}

std::vector<SceneValue> SceneValue::entries() const {
    if (!json->is_array()) expected("an array");
    std::vector<SceneValue> values;
    for (std::size_t k = 0; k < json->size(); ++k)
        values.push_back({&(*json)[k], file, path + "[" + std::to_string(k) + "]"});
    return values;
}

SceneObject::SceneObject(SceneValue value) : value_(std::move(value)) {
    if (!value_.json->is_object()) value_.expected("an object");
}

SceneValue SceneObject::find(const std::string& key) {
    if (std::find(known_keys_.begin(), known_keys_.end(), key) == known_keys_.end()) known_keys_.push_back(key);
    const auto found = value_.json->find(key);
    return {found != value_.json->end() ? &*found : nullptr, value_.file, key_path(value_.path, key)};
}

double SceneObject::number(const std::string& key, double fallback, const Range& range) {
    const SceneValue value = find(key);
    return value.json == nullptr ? fallback : value.number(range);
}

std::int64_t SceneObject::integer(const std::string& key, std::int64_t fallback, std::int64_t min, std::int64_t max) {
    const SceneValue value = find(key);
    return value.json == nullptr ? fallback : value.integer(min, max);
}

std::array<double, 3> SceneObject::vector3(const std::string& key, const std::array<double, 3>& fallback) {
    const SceneValue value = find(key);
    return value.json == nullptr ? fallback : value.vector3();
}

std::string SceneObject::only_one_of(const std::vector<std::string>& keys) {
    std::vector<std::string> present;
    for (const std::string& key : keys)
        if (has(key)) present.push_back(key);
    refuse_other_keys();
    if (present.empty()) value_.fail("is missing what it is, expected " + one_of(keys));
    if (present.size() > 1) value_.fail("has both " + present[0] + " and " + present[1] + ", expected " + one_of(keys));
    return present[0];
}

void SceneObject::refuse_other_keys() const {
    for (const auto& [key, unused] : value_.json->items()) {
        if (std::find(known_keys_.begin(), known_keys_.end(), key) == known_keys_.end()) {
            const SceneValue unknown{value_.json, value_.file, key_path(value_.path, key)};
            unknown.fail("unknown key, expected " + one_of(known_keys_));
        }
    }
}

std::string SceneObject::one_of(const std::vector<std::string>& names) {
    if (names.empty()) return "no key";
    std::string text = names.size() == 1 ? "" : "one of ";
    for (std::size_t k = 0; k < names.size(); ++k) text += (k == 0 ? "" : ", ") + names[k];
    return text;
}

}  // namespace apsl::scenes
