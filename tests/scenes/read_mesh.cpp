// SPDX-License-Identifier: MIT
#include "run/read_mesh.hpp"

#include "scenes/sample_files.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cstring>

using namespace apsl;
using namespace apsl::scenes;
using apsl::test::input_error_of;
using apsl::test::ply_text;
using apsl::test::TemporaryFolder;

namespace {

std::string error_of(const std::string& file, std::optional<double> height = {}) {
    return input_error_of([&] { read_mesh(file, height); });
}

template <class Value>
std::string bytes_of(const Value& value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

const std::vector<Triangle> kFanOfFour{{0, 1, 2}, {0, 2, 3}};

}  // namespace

TEST_CASE("OBJ: vertices keep their order, polygons are fanned, texture and normal indices are passed over") {
    const TemporaryFolder folder;
    const std::string file =
        folder.write("quad.obj",
                     "# comment\nmtllib missing.mtl\nv 0 0 0\nv +1 0 0\r\nv 1 1e0 0\nv 0 1 0.25\n"
                     "v 9 9 9\nvt 0 0\nvn 0 0 1\ng first\nf 1/1/1 2/1/1 3//1 4\ng second\nf -5 -4 -2\n");
    const Mesh mesh = read_mesh(file, {});
    CHECK(mesh.positions == std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25, 9, 9, 9});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}});
}

TEST_CASE("OBJ: what is wrong is named with its line or face") {
    const TemporaryFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    const auto [contents, message] = GENERATE_COPY(table<std::string, std::string>({
        {"v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates after v, got \"v nan 0 0\""},
        {"v 0 0 0\nv 1 inf 0\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates"},
        {"v 0 0 0\nv 1 0\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates"},
        {"v 0 0 0x\n" + corners + "f 1 2 3\n", ":1: expected three finite coordinates"},
        {corners + "f 1 2 2\n", ": face 0: names vertex 1 twice"},
        {corners + "f 1 2 3\nf 1 2 7\n", ": face 1: vertex 6 is out of range, the file has 3 vertices"},
        {"", ": has no vertices"},
        {"# nothing\n", ": has no vertices"},
        {corners, ": has no faces"},
    }));
    const std::string file = folder.write("bad.obj", contents);
    CAPTURE(contents);
    CHECK_THAT(error_of(file), Catch::StartsWith(file + message));
}

TEST_CASE("PLY in text: order and indices stay, polygons are fanned") {
    const TemporaryFolder folder;
    const std::string file =
        folder.write("quad.ply", ply_text(5, 2, "0 0 0\n1 0 0\n1 1 0\n0 1 0.25\n9 9 9\n4 0 1 2 3\n3 0 1 3\n"));
    const Mesh mesh = read_mesh(file, {});
    CHECK(mesh.positions == std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25, 9, 9, 9});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}});
}

TEST_CASE("PLY in binary, with properties that do not matter here") {
    static_assert(std::endian::native == std::endian::little);
    const TemporaryFolder folder;
    std::string contents =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nproperty uchar red\nelement face 1\nproperty list uchar uint vertex_index\nend_header\n";
    const std::vector<double> positions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25};
    for (std::size_t v = 0; v < 4; ++v) {
        for (std::size_t axis = 0; axis < 3; ++axis) contents += bytes_of(positions[3 * v + axis]);
        contents += '\x7f';
    }
    contents += '\x04';
    for (std::uint32_t v = 0; v < 4; ++v) contents += bytes_of(v);
    const Mesh mesh = read_mesh(folder.write("quad.PLY", contents), {});
    CHECK(mesh.positions == positions);
    CHECK(mesh.triangles == kFanOfFour);
}

TEST_CASE("PLY: what is wrong is named with its vertex or face") {
    const TemporaryFolder folder;
    const std::string corners = "0 0 0\n1 0 0\n1 1 0\n";
    const auto [contents, message] = GENERATE_COPY(table<std::string, std::string>({
        {ply_text(3, 1, "0 0 0\n1 nan 0\n1 1 0\n3 0 1 2\n"), ": vertex 1: expected three finite coordinates"},
        {ply_text(3, 1, corners + "3 0 1 7\n"), ": face 0: vertex 7 is out of range, the file has 3 vertices"},
        {ply_text(3, 1, corners + "3 0 1 -1\n"), ": face 0: vertex -1 is out of range"},
        {ply_text(3, 1, corners + "3 0 1 1\n"), ": face 0: names vertex 1 twice"},
        {ply_text(3, 1, corners + "2 0 1\n"), ": face 0: 2 vertices, expected at least 3"},
        {ply_text(3, 1, "0 0 zero\n1 0 0\n1 1 0\n3 0 1 2\n"), ": not a readable PLY mesh"},
        {ply_text(0, 0, ""), ": has no vertices"},
        {ply_text(3, 1, corners + "3 0 1 1.5\n"), ": not a readable PLY mesh: a face's vertex is no whole number"},
        {"", ": not a readable PLY mesh"},
        {"v 0 0 0\n", ": not a readable PLY mesh"},
    }));
    const std::string file = folder.write("bad.ply", contents);
    CAPTURE(contents);
    const std::string error = error_of(file);
    CHECK_THAT(error, Catch::StartsWith(file + message));
    CHECK(error.find('\n') == std::string::npos);
}

TEST_CASE("OBJ: no other file is opened, and faces may come before their vertices") {
    const TemporaryFolder folder;
    // A reader that looks at materials would never come to the end of this one.
    const std::string file = folder.write(
        "materials.obj", "mtllib ../../../../../../dev/zero\nusemtl cloth\nf 1 2 3 # first\nv 0 0 0\nv 1 0 0\nv 0 1 0");
    const Mesh mesh = read_mesh(file, {});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
    const std::string bad = folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n");
    CHECK_THAT(error_of(bad), Catch::StartsWith(bad + ":4: expected vertex numbers from 1"));
}

TEST_CASE("PLY: counts that the file cannot hold are refused before memory is asked for") {
    const TemporaryFolder folder;
    const std::string corners = "0 0 0\n1 0 0\n1 1 0\n";
    const std::string text = ply_text(3, 1, corners + "4000000000 0 1 2\n");
    CHECK_THAT(error_of(folder.write("list.ply", text)), Catch::Contains("a list is longer than the file"));
    const std::string vertices = ply_text(2000000000, 1, corners);
    CHECK_THAT(error_of(folder.write("vertices.ply", vertices)), Catch::Contains("ends before its last number"));
    const std::string header =
        "ply\nformat binary_big_endian 1.0\nelement nothing 18446744073709551615\nelement vertex 1\n"
        "property list int char x\nend_header\n";
    CHECK_THAT(error_of(folder.write("negative.ply", header + "\xff\xff\xff\xff")),
               Catch::Contains("or has no length"));
}

TEST_CASE("a face with very many vertices is read in no time") {
    const TemporaryFolder folder;
    std::string vertices, face = "f";
    for (int v = 1; v <= 200000; ++v) {
        vertices.append("v ").append(std::to_string(v)).append(" 0 0\n");
        face.append(" ").append(std::to_string(v));
    }
    CHECK(read_mesh(folder.write("polygon.obj", vertices + face + "\n"), {}).triangles.size() == 199998);
    const std::string twice = folder.write("twice.obj", vertices + face + " 7\n");
    CHECK_THAT(error_of(twice), Catch::Contains("names vertex 6 twice"));
}

TEST_CASE("PLY in binary, big end first") {
    const TemporaryFolder folder;
    std::string contents =
        "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty short x\r\nproperty uchar y\r\n"
        "property float z\r\nelement face 1\r\nproperty list ushort char vertex_index\r\nend_header\r\n";
    const std::string quarter("\x3e\x80\0\0", 4);
    contents += std::string("\xff\xfe\0", 3) + quarter + std::string("\0\1\0", 3) + quarter;
    contents += std::string("\0\0\xff", 3) + quarter + std::string("\0\3\0\1\2", 5);
    const Mesh mesh = read_mesh(folder.write("big.ply", contents), {});
    CHECK(mesh.positions == std::vector<double>{-2, 0, 0.25, 1, 0, 0.25, 0, 255, 0.25});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("height scales about the origin to the extent along y") {
    const TemporaryFolder folder;
    const std::string file = folder.write("tall.obj", "v 0 1 0\nv 2 5 0\nv 0 1 4\nf 1 2 3\n");
    CHECK(read_mesh(file, 2.0).positions == std::vector<double>{0, 0.5, 0, 1, 2.5, 0, 0, 0.5, 2});
    const std::string flat = folder.write("flat.obj", "v 0 1 0\nv 2 1 0\nv 0 1 4\nf 1 2 3\n");
    CHECK_THAT(error_of(flat, 2.0), Catch::Contains("all vertices have the same y"));
}

TEST_CASE("a file that is no mesh file says so") {
    const TemporaryFolder folder;
    const std::string missing = (folder.path() / "missing.obj").string();
    CHECK(error_of(missing) == missing + ": no such mesh file");
    CHECK(error_of(folder.path().string()) == folder.path().string() + ": no such mesh file");
    const std::string other = folder.write("mesh.stl", "solid");
    CHECK(error_of(other) == other + ": unknown kind of mesh file, expected .obj or .ply");
}
