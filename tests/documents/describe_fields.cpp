// SPDX-License-Identifier: MIT
//
// The tables of src/fields.hpp as JSON on standard output: what docs/write_fields.py makes documents of.
#include "fields.hpp"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>

namespace {

using Json = nlohmann::ordered_json;
using namespace apsl;

// With the digits that a float is written with.
Json shortest(float value) {
    std::ostringstream text;
    text << value;
    return Json::parse(text.str());
}

Json described(const Bounds& bounds) {
    Json json = Json::object();
    if (std::isfinite(bounds.least)) json[bounds.least_excluded ? "above" : "least"] = bounds.least;
    if (std::isfinite(bounds.greatest)) json[bounds.greatest_excluded ? "below" : "greatest"] = bounds.greatest;
    if (bounds.zero) json["zero"] = bounds.zero;
    return json;
}

template <class Struct, class... Fields>
Json described(const std::tuple<Fields...>& table) {
    Json fields = Json::array();
    for_each_field(table, [&](const auto& field) {
        const auto standard = Struct{}.*field.member;
        using Value = std::remove_const_t<decltype(standard)>;
        Json json{{"name", field.name}};
        if constexpr (std::is_enum_v<Value>) {
            json["type"] = "enum";
            json["default"] = name_of(standard);
            for (const auto& [value, name] : names_of<Value>) json["values"].push_back(name);
        } else if constexpr (std::is_same_v<Value, bool>) {
            json["type"] = "bool";
            json["default"] = standard;
        } else if constexpr (is_vector<Value>) {
            json["type"] = "vector";
            json["default"] = standard;
        } else if constexpr (std::is_floating_point_v<Value>) {
            json["type"] = "number";
            json["default"] = shortest(standard);
        } else {
            json["type"] = "integer";
            json["default"] = standard;
        }
        json["bounds"] = described(field.bounds);
        json["unit"] = field.unit;
        json["text"] = field.text;
        json["in_scenes"] = field.in_scenes;
        json["may_be_a_list"] = field.may_be_a_list;
        fields.push_back(json);
    });
    return fields;
}

}  // namespace

int main() {
    const Json fields{{"parameters", described<Parameters>(parameter_fields)},
                      {"options", described<Options>(option_fields)},
                      {"layout", described<Options>(layout_fields)}};
    std::cout << fields.dump(1) << '\n';
}
