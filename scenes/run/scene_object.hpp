// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace apsl::scenes {

/// What a number in a scene may be.
struct Range {
    double min = -std::numeric_limits<double>::infinity();
    bool min_excluded = false;
    double max = std::numeric_limits<double>::infinity();
    bool max_excluded = false;

    static Range above(double limit) { return {.min = limit, .min_excluded = true}; }
    static Range at_least(double limit) { return {.min = limit}; }
    static Range from_to_below(double first, double limit) {
        return {.min = first, .max = limit, .max_excluded = true};
    }
};

/// A value of a scene file that knows its place, for messages such as
/// "scenes/curtain.json: strain_limiting.regularization: expected a number ≥ 1, got 0.5".
struct SceneValue {
    const nlohmann::json* json;
    std::string file;
    std::string path;

    [[noreturn]] void fail(const std::string& what_was_wrong) const;
    [[noreturn]] void expected(const std::string& what) const;

    double number(const Range& range = {}) const;
    std::int64_t integer(std::int64_t min, std::int64_t max) const;
    std::string text() const;
    std::array<double, 3> vector3() const;
    /// The entries of an array.
    std::vector<SceneValue> entries() const;
};

/// One object of a scene file: hands out its values, and refuses the keys that nobody asked for.
class SceneObject {
public:
    /// Throws InputError where the value is not an object.
    explicit SceneObject(SceneValue value);

    /// The value of a key, json == nullptr where there is none.
    SceneValue find(const std::string& key);
    bool has(const std::string& key) { return find(key).json != nullptr; }

    double number(const std::string& key, double fallback, const Range& range = {});
    std::int64_t integer(const std::string& key, std::int64_t fallback, std::int64_t min, std::int64_t max);
    std::array<double, 3> vector3(const std::string& key, const std::array<double, 3>& fallback);

    /// `choices`: pairs of a name and what it means.
    template <class Choice, class Choices = std::initializer_list<std::pair<const char*, Choice>>>
    Choice choice(const std::string& key, Choice fallback, const Choices& choices) {
        const SceneValue value = find(key);
        if (value.json == nullptr) return fallback;
        const std::string name = value.json->is_string() ? value.text() : std::string{};
        std::vector<std::string> names;
        for (const auto& [known, meaning] : choices) {
            if (name == known) return meaning;
            names.emplace_back(known);
        }
        value.expected(one_of(names));
    }

    /// The one key of these that is there. Throws InputError where there are none, several, or keys that nobody asked
    /// for: ask first for those that may stand beside it.
    std::string only_one_of(const std::vector<std::string>& keys);

    /// Call it when all values have been asked for. Throws InputError for a key that was not.
    void refuse_other_keys() const;

    const SceneValue& value() const { return value_; }

private:
    static std::string one_of(const std::vector<std::string>& names);

    SceneValue value_;
    std::vector<std::string> known_keys_;
};

}  // namespace apsl::scenes
