// SPDX-License-Identifier: MIT
#include "run/override_scene.hpp"

#include "scenes/sample_files.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

using apsl::scenes::override_scene;
using apsl::test::input_error_of;

namespace {

nlohmann::json changed(const std::string& before, const std::string& assignment) {
    nlohmann::json document = nlohmann::json::parse(before);
    override_scene(document, assignment);
    return document;
}

}  // namespace

TEST_CASE("set: changes, adds and takes out values") {
    const auto [before, assignment, after] = GENERATE(table<std::string, std::string, std::string>({
        {R"({"a": {"b": 1, "c": 2}})", "a.b=1.5", R"({"a": {"b": 1.5, "c": 2}})"},
        {R"({})", "a.b.c=[1, 2]", R"({"a": {"b": {"c": [1, 2]}}})"},
        {R"({"a": 1})", "b=uniform", R"({"a": 1, "b": "uniform"})"},
        {R"({"a": 1})", "b=\"1\"", R"({"a": 1, "b": "1"})"},
        {R"({"a": 1, "b": 2})", "b=null", R"({"a": 1})"},
        {R"({"a": [{"b": 1}]})", "a[0].b=2", R"({"a": [{"b": 2}]})"},
        {R"({"a": [{"b": 1}]})", "a.0.b=2", R"({"a": [{"b": 2}]})"},
        {R"({"a": [1]})", "a[1]={\"b\": 2}", R"({"a": [1, {"b": 2}]})"},
        {R"({"a": [1]})", "a[1].b=2", R"({"a": [1, {"b": 2}]})"},
        {R"({"a": [1, 2]})", "a[0]=null", R"({"a": [null, 2]})"},
        {R"({"a": [1]})", "a[1]=null", R"({"a": [1, null]})"},
        {R"({"a": 1})", "b=x=y", R"({"a": 1, "b": "x=y"})"},
    }));
    CAPTURE(before, assignment);
    CHECK(changed(before, assignment) == nlohmann::json::parse(after));
}

TEST_CASE("set: null takes out what is there, and says where nothing is") {
    nlohmann::json document = nlohmann::json::parse(R"({"a": {"b": 1}, "list": [{}]})");
    const nlohmann::json before = document;
    for (const char* absent : {"b=null", "a.c=null", "a.c.d=null", "c.d.e=null", "list[0].a=null"}) {
        CAPTURE(absent);
        CHECK_FALSE(override_scene(document, absent));
        CHECK(document == before);
    }
    CHECK(override_scene(document, "a.c=1"));
    CHECK(override_scene(document, "a.b=null"));
    CHECK(document == nlohmann::json::parse(R"({"a": {"c": 1}, "list": [{}]})"));
}

TEST_CASE("set: of one kind of mesh or integrator puts it in place of the others") {
    CHECK(changed(R"({"mesh": {"grid": {}}})", "mesh.file=/tmp/x.obj") ==
          nlohmann::json::parse(R"({"mesh": {"file": "/tmp/x.obj"}})"));
    CHECK(changed(R"({"mesh": {"file": "x.obj", "height": 1}})", "mesh.grid.jitter=0.1") ==
          nlohmann::json::parse(R"({"mesh": {"grid": {"jitter": 0.1}}})"));
    CHECK(changed(R"({"mesh": {"file": "x.obj"}})", "mesh.height=2") ==
          nlohmann::json::parse(R"({"mesh": {"file": "x.obj", "height": 2}})"));
    CHECK(changed(R"({"integrator": {"implicit_springs": {"damping": 1}}})", "integrator.stand_alone={}") ==
          nlohmann::json::parse(R"({"integrator": {"stand_alone": {}}})"));
}

TEST_CASE("set: mesh.file is relative to the working directory") {
    CHECK(changed("{}", "mesh.file=meshes/../x.obj")["mesh"]["file"] ==
          (std::filesystem::current_path() / "x.obj").string());
}

TEST_CASE("set: that leads nowhere says where it stopped") {
    const auto [assignment, message] = GENERATE(table<std::string, std::string>({
        {"a", "--set a: expected path=value"},
        {"=1", "--set =1: expected path=value"},
        {"a..b=1", "--set a..b=1: expected path=value"},
        {"a.b=1", "--set a.b=1: there is no \"b\" in 3"},
        {"list[5]=1", "--set list[5]=1: there is no \"5\" in [1]"},
        {"a={\"b\": [{\"c\": 1, \"c\": 2}]}",
         "--set a={\"b\": [{\"c\": 1, \"c\": 2}]}: b[0].c: the same key comes twice"},
        {"a=" + std::string(65, '[') + std::string(65, ']'), "--set a=" + std::string(65, '[')},
        {"a=\xff", "--set a=\xff: expected text in UTF-8"},
        {"\xff=1", "--set \xff=1: expected text in UTF-8"},
        {"x" + std::string(100000, '.') + "=1", "--set x"},
        {"list.x=1", "--set list.x=1: there is no \"x\" in [1]"},
        {"gravity[1]=-1",
         "--set gravity[1]=-1: there is no \"gravity\" in the scene, expected all of it, gravity=[...]"},
        {"mesh.grid.size[0]=2",
         "--set mesh.grid.size[0]=2: there is no \"size\" in the scene, expected all of it, size=[...]"},
    }));
    nlohmann::json document = nlohmann::json::parse(R"({"a": 3, "list": [1]})");
    CHECK_THAT(input_error_of([&, given = assignment] { override_scene(document, given); }),
               Catch::StartsWith(message));
}

TEST_CASE("set: a path of any length is an error or a change, no end of the program") {
    std::string path = "a";
    for (int k = 1; k < 64; ++k) path += ".a";
    nlohmann::json document = nlohmann::json::object();
    override_scene(document, path + "=1");
    for (int k = 64; k < 100000; ++k) path += ".a";
    CHECK(input_error_of([&] { override_scene(document, path + "=1"); }) ==
          "--set a...: a path of 100000 keys, expected at most 64");
}
