// SPDX-License-Identifier: MIT
#include "run/read_obj.hpp"

#include "run/input_error.hpp"
#include "run/words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace apsl::scenes {
namespace {

/// A v or f line, with those that a backslash joins to it.
struct Statement {
    std::string_view key;   // "v", "f", or another that does not matter here
    std::string_view rest;  // behind the key, without a comment
    std::string_view line;  // its first line, for messages
    std::size_t number;     // of that line, from 1
};

class Statements {
public:
    explicit Statements(std::string_view contents) : contents_(contents) {}

    bool at_end() const { return contents_.empty(); }

    Statement take() {
        Statement statement{.key = {}, .rest = {}, .line = take_line(contents_), .number = ++lines_};
        std::string_view part = without_comment(statement.line);
        statement.rest = part;
        statement.key = take_word(statement.rest);
        if (!goes_on(part)) return statement;
        if (statement.key == "v\\" || statement.key == "f\\") {
            statement.key.remove_suffix(1);
            statement.rest = part.substr(static_cast<std::size_t>(statement.key.end() - part.begin()));
        }
        // Elsewhere, as in a name or a comment, a backslash is a letter like any other.
        if (statement.key != "v" && statement.key != "f") return statement;
        joined_.clear();
        for (part = statement.rest; goes_on(part); part = without_comment(take_line(contents_)), ++lines_)
            joined_.append(part.substr(0, part.find_last_of('\\'))).append(" ");
        statement.rest = joined_.append(part);
        return statement;
    }

private:
    static std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

    static bool goes_on(std::string_view part) {
        const std::size_t last = part.find_last_not_of(" \t");
        return last != std::string_view::npos && part[last] == '\\';
    }

    std::string_view contents_;
    std::string joined_;
    std::size_t lines_ = 0;
};

[[noreturn]] void refuse(const std::string& file, const Statement& statement, const std::string& what) {
    throw InputError(file + ":" + std::to_string(statement.number) + ": " + what);
}

void add_vertex(PolygonMesh& mesh, const Statement& statement) {
    std::string_view coordinates = statement.rest;
    for (int axis = 0; axis < 3; ++axis) {
        double coordinate = 0.0;
        if (!parse_number(take_word(coordinates), coordinate) || !std::isfinite(coordinate))
            refuse(mesh.file, statement, "expected three finite coordinates after v, got " + quoted(statement.line));
        mesh.positions.push_back(coordinate);
    }
}

// What other programs write beside vertices and faces, and this one passes over.
constexpr std::string_view other_keys[] = {
    "vt",     "vn",    "vp",   "p",     "l",        "g",        "s",    "mg",     "o",      "usemtl",     "mtllib",
    "cstype", "deg",   "bmat", "step",  "curv",     "curv2",    "surf", "parm",   "trim",   "hole",       "scrv",
    "sp",     "end",   "con",  "bevel", "c_interp", "d_interp", "lod",  "usemap", "maplib", "shadow_obj", "trace_obj",
    "ctech",  "stech", "call", "csh",   "bsp",      "bzp",      "cdc",  "cdp",    "res"};

bool is_other_key(std::string_view key) {
    return key.empty() || std::find(std::begin(other_keys), std::end(other_keys), key) != std::end(other_keys);
}

// v, v/vt, v//vn or v/vt/vn: only v counts, but the others are numbers too.
bool parse_corner(std::string_view corner, std::int64_t& vertex) {
    for (int part = 0; part < 3; ++part) {
        const std::size_t slash = corner.find('/');
        std::int64_t number = 0;
        const std::string_view word = corner.substr(0, slash);
        if (!(word.empty() && part > 0) && !parse_number(word, number)) return false;
        if (part == 0) vertex = number;
        if (slash == std::string_view::npos) return vertex != 0;
        corner.remove_prefix(slash + 1);
    }
    return false;
}

// Counted from 1, or back from the last vertex before the
// line.
void add_face(PolygonMesh& mesh, const Statement& statement) {
    std::string_view corners = statement.rest;
    for (std::string_view corner = take_word(corners); !corner.empty(); corner = take_word(corners)) {
        std::int64_t number = 0;
        if (!parse_corner(corner, number)) {
            refuse(mesh.file, statement,
                   "expected vertex numbers from 1, or from -1 back, after f, got " + quoted(statement.line));
        }
        const auto before = static_cast<std::int64_t>(mesh.vertex_count());
        if (number < -before) {
            refuse(mesh.file, statement,
                   "vertex " + std::to_string(number) + " is out of range, " + std::to_string(before) +
                       " vertices come before it");
        }
        mesh.add_corner(number, number > 0 ? number - 1 : before + number);
    }
    mesh.end_face(statement.number);
}

}  // namespace

PolygonMesh read_obj(std::string_view contents, const std::string& file) {
    PolygonMesh mesh;
    mesh.file = file;
    mesh.has_lines = true;
    Statements statements(contents);
    std::size_t unknown = 0;
    std::string first_unknown;
    while (!statements.at_end()) {
        const Statement statement = statements.take();
        if (statement.key == "v")
            add_vertex(mesh, statement);
        else if (statement.key == "f")
            add_face(mesh, statement);
        else if (!is_other_key(statement.key) && unknown++ == 0)
            first_unknown = "line " + std::to_string(statement.number) + ", " + quoted(statement.line);
    }
    if (unknown > 0) {
        mesh.warnings.push_back(file + ": lines that OBJ does not have: " + std::to_string(unknown) +
                                ", the first in " + first_unknown + "; they are left out");
    }
    check_faces(mesh);  // at the end, for a face may come before its vertices
    return mesh;
}

}  // namespace apsl::scenes
