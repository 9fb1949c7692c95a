// SPDX-License-Identifier: MIT
#include "run/parse_json.hpp"

#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>

using apsl::scenes::parse_json;
using apsl::test::input_error_of;

TEST_CASE("text nested too deep is refused, however deep") {
    const std::string deep(1000000, '[');
    const auto error = [](const std::string& text) { return input_error_of([&] { parse_json(text, "scene.json"); }); };
    CHECK(error(deep) == "scene.json: nested more than 64 deep, expected a scene");
    CHECK(error(std::string(64, '[') + std::string(64, ']')).empty());
    CHECK_THAT(error("{\"mesh\":"), Catch::StartsWith("scene.json: not valid JSON: parse error at line 1"));
}

TEST_CASE("a key that comes twice is named by its path") {
    const auto [text, message] = GENERATE(table<std::string, std::string>({
        {R"({"frames": 1, "frames": 2})", "frames: the same key comes twice"},
        {R"({"mesh": {"grid": {}}, "strain_limiting": {"sub_steps": 1, "sub_steps": 1}})",
         "strain_limiting.sub_steps: the same key comes twice"},
        {R"({"pins": [{"box": {}}, {"motion": {"rotate": [1, {"a": [], "b": {}, "a": 1}]}}]})",
         "pins[1].motion.rotate[1].a: the same key comes twice"},
        {"{\"a\": 1, \"\\u0061\": 2}", "a: the same key comes twice"},
        {"{\"\": 1, \"\": 2}", ": the same key comes twice"},
    }));
    CHECK(input_error_of([given = text] { parse_json(given, "scene.json"); }) ==
          "scene.json: " + message + ", expected it once");
    CHECK(parse_json(R"([{"a": {"a": 1}}, {"a": [{"a": 2}, {"a": 3}]}])", "scene.json").size() == 2);
}

TEST_CASE("a scene begins with a byte order mark or without, and is no UTF-16") {
    CHECK(parse_json("\xef\xbb\xbf{\"frames\": 3}", "scene.json")["frames"] == 3);
    CHECK(input_error_of([] { parse_json(std::string("\xff\xfe{\0", 4), "scene.json"); }) ==
          "scene.json: is text in UTF-16, expected UTF-8 or ASCII");
}
