// SPDX-License-Identifier: MIT
#include "run/read_mesh.hpp"

#include "scenes/sample_files.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

using namespace apsl;
using namespace apsl::scenes;
using apsl::test::input_error_of;
using apsl::test::ply_text;
using apsl::test::TemporaryFolder;

namespace {

Mesh read_mesh(const std::string& file, std::optional<double> height = {}) {
    return scenes::read_mesh(MeshFile{.file = file, .height = height});
}

std::string error_of(const std::string& file, std::optional<double> height = {}) {
    return input_error_of([&] { read_mesh(file, height); });
}

template <class Value>
std::string bytes_of(const Value& value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

const std::string square = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";
const std::vector<Triangle> fan_of_four{{0, 1, 2}, {0, 2, 3}};

}  // namespace

TEST_CASE("OBJ: vertices keep their order, polygons are fanned, texture and normal indices are passed over") {
    const TemporaryFolder folder;
    const std::string file =
        folder.write("quad.obj",
                     "# comment\nmtllib missing.mtl\nv 0 0 0\nv +1 0 0\r\nv 1 1e0 0\nv 0 1 0.25\n"
                     "v 9 9 9\nvt 0 0\nvn 0 0 1\ng first\nf 1/1/1 2/1/1 3//1 4\ng second\nf -5 -4 -2\n");
    const Mesh mesh = read_mesh(file);
    CHECK(mesh.positions == std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25, 9, 9, 9});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}});
}

TEST_CASE("OBJ: what is wrong is named with its line and the file's own numbers") {
    const TemporaryFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    const auto [contents, message] = GENERATE_COPY(table<std::string, std::string>({
        {"v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates after v, got \"v nan 0 0\""},
        {"v 0 0 0\nv 1 inf 0\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates"},
        {"v 0 0 0\nv 1 0\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates"},
        {"v +-1 0 0\n" + corners + "f 1 2 3\n", ":1: expected three finite coordinates"},
        {"v 0 0 0x\n" + corners + "f 1 2 3\n", ":1: expected three finite coordinates"},
        {"v 0 0 0\nv 1 1e39 1e400\nv 1 1 0\nf 1 2 3\n", ":2: expected three finite coordinates"},
        {corners + "f 1 2\n", ":4: 2 vertices, expected at least 3"},
        {corners + "f\n", ":4: 0 vertices, expected at least 3"},
        {corners + "f 1 2 3\nf 1 2 7\n", ":5: vertex 7 is out of range, the file has 3 vertices"},
        {corners + "f 1 2 9223372036854775807\n", ":4: vertex 9223372036854775807 is out of range"},
        {corners + "f 1 2 -5\n" + corners, ":4: vertex -5 is out of range, 3 vertices come before it"},
        {corners + "f 1 2 -9223372036854775808\n", ":4: vertex -9223372036854775808 is out of range"},
        {corners + "f 1 2 99999999999999999999\n", ":4: expected vertex numbers from 1"},
        {corners + "f 1 2 3.0\n", ":4: expected vertex numbers from 1"},
        {corners + "f 1/a 2 3\n", ":4: expected vertex numbers from 1"},
        {corners + "f 1/1/1/1 2 3\n", ":4: expected vertex numbers from 1"},
        {corners + "v 2 0 0\nv 2 1 0\nf 1 2 3 1 4 5 1 3\n", ":6: a face that pinches itself (line 6, 1 2 3 1"},
        {corners + "\nv 2 0 \\\n0\nf 1 2 \\\n-1\n",
         ":7: a face without an area, or with vertices in one place (line 7, 1 2 -1)"},
        {corners + "v 0 0 -0\nf 1 2 3 4\n",
         ":5: a face without an area, or with vertices in one place (line 5, 1 2 3 4)"},
        {"v 1e308 0 0\nv 0 1e308 0\nv -1e308 0 0\nf 1 2 3", ":4: a face with an area too great for a number"},
        {corners + "f 1 1 2\nf 3 3 3\n", ": has no faces that enclose anything"},
        {"", ": has no vertices"},
        {"# nothing\n", ": has no vertices"},
        {corners, ": has no faces"},
        {corners + "fo 1 2 3\n", ": has no faces ("},
    }));
    const std::string file = folder.write("bad.obj", contents);
    CAPTURE(contents);
    CHECK_THAT(error_of(file), Catch::StartsWith(file + message));
}

TEST_CASE("PLY in text: order and indices stay, polygons are fanned") {
    const TemporaryFolder folder;
    const std::string file =
        folder.write("quad.ply", ply_text(5, 2, "0 0 0\n1 0 0\n1 1 0\n0 1 0.25\n9 9 9\n4 0 1 2 3\n3 0 1 3\n"));
    const Mesh mesh = read_mesh(file);
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
    const Mesh mesh = read_mesh(folder.write("quad.PLY", contents));
    CHECK(mesh.positions == positions);
    CHECK(mesh.triangles == fan_of_four);
    CHECK(read_mesh(folder.write("line_end.ply", contents + "\r\n")).triangles == fan_of_four);
    const std::string longer = folder.write("longer.ply", contents + contents.substr(contents.size() - 17));
    CHECK(error_of(longer) ==
          longer + ": not a readable PLY mesh: goes on behind what its header counts, for 17 bytes");
}

TEST_CASE("PLY: what is wrong is named with its vertex or face") {
    const TemporaryFolder folder;
    const std::string corners = "0 0 0\n1 0 0\n1 1 0\n";
    const auto [contents, message] = GENERATE_COPY(table<std::string, std::string>({
        {ply_text(3, 1, "0 0 0\n1 nan 0\n1 1 0\n3 0 1 2\n"), ":11: vertex 1: expected three finite coordinates"},
        {ply_text(3, 1, corners + "3 0 1 7\n"), ": face 0: vertex 7 is out of range, the file has 3 vertices"},
        {ply_text(3, 1, corners + "3 0 1 -1\n"), ": face 0: vertex -1 is out of range"},
        {ply_text(3, 1, corners + "3 0 1 1\n"), ": has no faces that enclose anything"},
        {ply_text(4, 1, corners + "2 0 0\n3 0 1 3\n"), ": face 0: a face without an area"},
        {ply_text(3, 1, corners + "3 0 1 2\n3 0 2 1\n"),
         ":14: not a readable PLY mesh: goes on behind what its header"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertices\nend_header\n3 0 1 2\n",
         ": not a readable PLY mesh: face without a list vertex_indices"},
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty list int int y\nend_header\n1\n2\n3\n",
         ": not a readable PLY mesh: vertex without a property y"},
        {"plyer\nformat ascii 1.0\n", ": not a readable PLY mesh: expected ply in the first line"},
        {ply_text(3, 1, corners + "2 0 1\n"), ": face 0: 2 vertices, expected at least 3"},
        {ply_text(3, 1, "0 0 0\n1 0 zero\n1 1 0\n3 0 1 2\n"),
         ":11: not a readable PLY mesh: expected a number, got \"zero\""},
        {ply_text(0, 0, ""), ": has no vertices"},
        {ply_text(3, 1, corners + "3 0 1 1.5\n"), ":13: not a readable PLY mesh: a face's vertex is no whole number"},
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
    const Mesh mesh = read_mesh(file);
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
        "property list int char n\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    CHECK_THAT(error_of(folder.write("negative.ply", header + "\xff\xff\xff\xff")),
               Catch::Contains("or has no length"));
}

TEST_CASE("a face with very many vertices is read in no time") {
    const TemporaryFolder folder;
    std::string circle, line, comb, face = "f";
    for (int v = 1; v <= 200000; ++v) {
        const double angle = v * 3.14159265358979e-5;
        circle.append("v ").append(std::to_string(1e6 * std::cos(angle)));
        circle.append(" ").append(std::to_string(1e6 * std::sin(angle))).append(" 0\n");
        line.append("v ").append(std::to_string(v)).append(" 0 0\n");
        comb.append("v ").append(std::to_string(v)).append(v % 2 == 0 ? " 1 0\n" : " 2 0\n");
        face.append(" ").append(std::to_string(v));
    }
    CHECK(read_mesh(folder.write("circle.obj", circle + face + "\n")).triangles.size() == 199998);
    CHECK(read_mesh(folder.write("closed.obj", circle + face + " 1\n")).triangles.size() == 199998);
    const std::string flat = folder.write("line.obj", line + face + "\n");
    CHECK_THAT(error_of(flat), Catch::StartsWith(flat + ":200001: a face without an area"));
    const std::string concave = folder.write("comb.obj", comb + "v 200000 0 0\nv 1 0 0\n" + face + " -2 -1\n");
    CHECK_THAT(error_of(concave), Catch::StartsWith(concave + ":200003: a concave face of 200002 vertices"));
}

TEST_CASE("PLY in binary, big end first") {
    const TemporaryFolder folder;
    std::string contents =
        "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty short x\r\nproperty uchar y\r\n"
        "property float z\r\nelement face 1\r\nproperty list ushort char vertex_index\r\nend_header\r\n";
    const std::string quarter("\x3e\x80\0\0", 4);
    contents += std::string("\xff\xfe\0", 3) + quarter + std::string("\0\1\0", 3) + quarter;
    contents += std::string("\0\0\xff", 3) + quarter + std::string("\0\3\0\1\2", 5);
    const Mesh mesh = read_mesh(folder.write("big.ply", contents));
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
    CHECK(error_of(folder.path().string()) ==
          folder.path().string() + ": is a folder or a device, expected a mesh file");
    CHECK(error_of("/dev/zero") == "/dev/zero: is a folder or a device, expected a mesh file");
    const std::string other = folder.write("mesh.stl", "solid");
    CHECK(error_of(other) == other + ": unknown kind of mesh file, expected .obj or .ply");
}

TEST_CASE("OBJ: a backslash at the end of a v or f line joins the next one to it") {
    const TemporaryFolder folder;
    const std::string end = GENERATE("\n", "\r\n", "\r");
    std::string text = GENERATE("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 \\\n 3 4\n",
                                "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1/1 2/2 3/3\\\n4/4",
                                "v 0 0\\\n0\nv 2 \\ \n0 \\\n\t0\nv\\\n2 1 0\nv 0 1 0\nf \\\n1 2\\\n3 4 \\\n\nf 4 4 4",
                                "v 0 0 0 # \\\nv 2 0 0\nv 2 1 0\no C:\\\nv 0 1 0\n# \\\nf 1 2 3 4 # 1 \\\n \\");
    for (std::size_t k = text.find('\n'); k != std::string::npos; k = text.find('\n', k + end.size()))
        text.replace(k, 1, end);
    CAPTURE(text);
    const Mesh mesh = read_mesh(folder.write("joined.obj", text));
    CHECK(mesh.positions == std::vector<double>{0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0});
    CHECK(mesh.triangles == fan_of_four);
}

TEST_CASE("a byte order mark is no part of the first line, and UTF-16 is refused") {
    const TemporaryFolder folder;
    const std::string mark = "\xef\xbb\xbf";
    CHECK(read_mesh(folder.write("mark.obj", mark + square + "v 5 5 5\nf 1 2 3 4\n")).triangles == fan_of_four);
    CHECK(read_mesh(folder.write("mark.ply", mark + ply_text(3, 1, "0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"))).triangles ==
          std::vector<Triangle>{{0, 1, 2}});
    const std::string wide = folder.write("wide.obj", std::string("\xff\xfev\0 \0", 6));
    CHECK(error_of(wide) == wide + ": is text in UTF-16, expected UTF-8 or ASCII");
}

TEST_CASE("vertices that a face names twice: closed polygons and spikes are read, what encloses nothing is left out") {
    const TemporaryFolder folder;
    const std::string face =
        GENERATE("f 1 2 3 4 1\n", "f 1 1 2 3 3 3 4\n", "f 2 3 4 1 4 1 2 1\n", "f 4 1 2 3 4 3 4 4\n", "f 2 1 2 3 4 1\n");
    CAPTURE(face);
    const Mesh mesh = read_mesh(folder.write("closed.obj", square + face));
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.warnings.empty());

    const std::string file = folder.write("twice.obj", square + "f 1 2 3\nf 1 3 4\nf 4 4 1\nf 1 2 3 2\nf -1 -2 -1\n");
    const Mesh flawed = read_mesh(file);
    CHECK(flawed.triangles == fan_of_four);
    CHECK(flawed.warnings ==
          std::vector<std::string>{file + ": faces that enclose nothing, for a vertex comes twice: 3, "
                                          "the first in line 7, 4 4 1; they are left out"});
    const std::string ply = folder.write("twice.ply", ply_text(3, 2, "0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n3 0 1 0\n"));
    CHECK(read_mesh(ply).warnings ==
          std::vector<std::string>{ply + ": faces that enclose nothing, for a vertex comes twice: "
                                         "1, the first in face 1, 0 1 0; they are left out"});
}

TEST_CASE("OBJ: lines of another format are warned of, those that OBJ has are not") {
    const TemporaryFolder folder;
    const std::string face = "f 1 2 3 4\n";
    const std::string known = "o a\ng b\ns off\nusemtl c\nvp 0 0\nl 1 2\np 1\nlod 1\n\n";
    CHECK(read_mesh(folder.write("known.obj", square + known + face)).warnings.empty());
    const std::string file =
        folder.write("unknown.obj", square + face + "F 1 2 3\nfoo bar\n" + std::string("\0 f\n", 4));
    const Mesh mesh = read_mesh(file);
    CHECK(mesh.triangles == fan_of_four);
    CHECK(mesh.warnings == std::vector<std::string>{file + ": lines that OBJ does not have: 3, the first in line 6, "
                                                           "\"F 1 2 3\"; they are left out"});
}

TEST_CASE("faces that come twice, on either side, are warned of") {
    const TemporaryFolder folder;
    const std::string file = folder.write("twosided.obj", square + "f 1 2 3 4\nf 4 1 3\nf 3 2 1\nf 1 2 4\n");
    CHECK(read_mesh(file).triangles.size() == 5);
    CHECK(read_mesh(file).warnings ==
          std::vector<std::string>{file + ": faces that come twice: 2, the first in line 6, 4 1 3; each weighs and "
                                          "counts, delete them from the mesh"});
}

TEST_CASE("PLY: triangle strips turn every other triangle round, -1 begins anew, what names a vertex twice leads on") {
    const TemporaryFolder folder;
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string strips = "element tristrips 2\nproperty list int int vertex_indices\n";
    const std::string points = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n4 0 0\n";
    const Mesh mesh = read_mesh(
        folder.write("strips.ply", header + strips + "end_header\n" + points + "9 0 1 3 2 -1 1 4 4 2\n4 -1 0 1 -1\n"));
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {3, 1, 2}});
    CHECK(mesh.warnings.empty());
    const Mesh led_on =
        read_mesh(folder.write("led_on.ply", header + strips + "end_header\n" + points + "6 0 1 3 3 2 1\n3 1 4 2\n"));
    CHECK(led_on.triangles == std::vector<Triangle>{{0, 1, 3}, {2, 3, 1}, {1, 4, 2}});
    // The same surface once more, as some scanners write it.
    const Mesh faces = read_mesh(folder.write(
        "both.ply", header + strips + "element face 1\nproperty list uchar int vertex_index\nend_header\n" + points +
                        "3 0 1 3\n3 1 2 3\n3 0 1 2\n"));
    CHECK(faces.triangles == std::vector<Triangle>{{0, 1, 2}});
    REQUIRE(faces.warnings.size() == 1);
    CHECK_THAT(faces.warnings[0], Catch::EndsWith("both.ply: triangle strips beside faces: 2; they are left out, "
                                                  "taken for the same surface"));
    const std::string bad = folder.write("bad.ply", header + strips + "end_header\n" + points + "3 0 1 2\n3 0 1 -2\n");
    CHECK_THAT(error_of(bad), Catch::StartsWith(bad + ": face 1: vertex -2 is out of range"));
}

TEST_CASE(
    "PLY: blanks in the header, wide whole numbers, numbers below a double's range, a body that begins with \\n") {
    const TemporaryFolder folder;
    const Mesh text = read_mesh(folder.write(
        "text.ply",
        "ply \t\nformat ascii 1.0 \nelement vertex 3 \nproperty int64 x\nproperty double y\nproperty double z\n"
        "element face 1\nproperty list uint64 int64 vertex_indices\nend_header  \n-7 1e-400 -1e-400\n1 0 4e-320\n1 "
        "1 "
        "0\n3 0 1 2"));
    CHECK(text.positions == std::vector<double>{-7, 0, 0, 1, 0, 4e-320, 1, 1, 0});

    const std::string end = GENERATE("\n", "\r\n", "\r");
    std::string header =
        "ply|format binary_little_endian 1.0|element vertex 3|property char x|property ulong y|"
        "property long z|element face 1|property list long ulong vertex_indices|end_header|";
    for (std::size_t k = header.find('|'); k != std::string::npos; k = header.find('|')) header.replace(k, 1, end);
    std::string body;
    for (const std::int64_t v : {0, 1, 2}) {
        body += v == 0 ? '\x0a' : '\x0d';
        body += bytes_of(std::uint64_t{10} * v) + bytes_of(-v);
    }
    for (const std::int64_t number : {3, 0, 1, 2}) body += bytes_of(number);
    const Mesh binary = read_mesh(folder.write("binary.ply", header + body));
    CHECK(binary.positions == std::vector<double>{10, 0, 0, 13, 10, -1, 13, 20, -2});
    CHECK(binary.triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("a weld makes one vertex of those in one place, and drops what it closes") {
    const TemporaryFolder folder;
    const std::string file = folder.write(
        "soup.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 0 0.001\nv 2 2 0\nv 0 2 0\nv 0 0 0\nf 1 2 3\nf 4 5 6\nf 1 7 2\n");
    const Mesh mesh = scenes::read_mesh({.file = file, .height = 1.0, .weld = 0.001});
    CHECK(mesh.positions == std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    CHECK(mesh.welded_to == std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 0});
    REQUIRE(mesh.warnings.size() == 1);
    CHECK_THAT(mesh.warnings[0], Catch::Contains("the first in line 10, 1 7 2"));
    CHECK_THAT(input_error_of([&] { scenes::read_mesh({.file = file, .height = {}, .weld = 0.0}); }),
               Catch::StartsWith(file + ":10: a face without an area"));
    CHECK(input_error_of([&] { scenes::read_mesh({.file = file, .height = {}, .weld = 5.0}); }) ==
          file +
              ": has no faces that enclose anything once vertices within mesh.weld, 5 m, are one; the mesh extends "
              "over 2.83 m");
}
