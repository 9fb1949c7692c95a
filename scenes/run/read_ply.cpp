// SPDX-License-Identifier: MIT
#include "run/read_ply.hpp"

#include "run/input_error.hpp"
#include "run/ply_header.hpp"
#include "run/words.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

namespace apsl::scenes {
namespace {

/// Numbers one after the other, as the header says they are written.
class PlyNumbers {
public:
    /// `whole`: the file, of which `contents` is what follows the header.
    PlyNumbers(PlyFormat format, std::string_view contents, std::string_view whole, const std::string& file)
        : format_(format), whole_(whole), rest_(contents), file_(file) {}

    double next(const PlyType& type) { return format_ == PlyFormat::ascii ? next_word() : next_bytes(type); }

    /// Behind the last number there is at most a line end; who counted wrong left faces out.
    void check_end() {
        const std::size_t left = rest_.size();
        const std::string_view word = take_word(rest_, blanks);
        if (word.empty()) return;
        if (format_ == PlyFormat::ascii) refuse("goes on behind what its header counts, with " + quoted(word));
        refuse("goes on behind what its header counts, for " + std::to_string(left) + " bytes");
    }

    /// "mesh.ply:7", with the line of the number taken last where the file is text; "mesh.ply" where not.
    std::string where() const {
        if (format_ != PlyFormat::ascii) return file_;
        std::string_view before = whole_.substr(0, whole_.size() - rest_.size());
        std::size_t line = 0;
        for (; !before.empty(); ++line) take_line(before);
        return file_ + ":" + std::to_string(line);
    }

    [[noreturn]] void refuse(const std::string& what) const { refuse_ply(where(), what); }

    /// The least that a number takes: what bounds every count by the size of the file.
    std::size_t least_bytes(const PlyType& type) const { return format_ == PlyFormat::ascii ? 1 : type.size; }
    std::size_t bytes_left() const { return rest_.size(); }

private:
    static constexpr std::string_view blanks = " \t\r\n";

    double next_word() {
        const std::string_view word = take_word(rest_, blanks);
        double number = 0.0;
        if (word.empty()) refuse("ends before its last number");
        if (!parse_number(word, number)) refuse("expected a number, got " + quoted(word));
        return number;
    }

    double next_bytes(const PlyType& type) {
        if (rest_.size() < type.size) refuse("ends before its last number");
        unsigned char bytes[8];
        std::memcpy(bytes, rest_.data(), type.size);
        rest_.remove_prefix(type.size);
        const bool little = format_ == PlyFormat::binary_little_endian;
        if (little != (std::endian::native == std::endian::little)) std::reverse(bytes, bytes + type.size);
        return type.is_float    ? (type.size == 4 ? number<float>(bytes) : number<double>(bytes))
               : type.size == 1 ? (type.is_signed ? number<std::int8_t>(bytes) : number<std::uint8_t>(bytes))
               : type.size == 2 ? (type.is_signed ? number<std::int16_t>(bytes) : number<std::uint16_t>(bytes))
               : type.size == 4 ? (type.is_signed ? number<std::int32_t>(bytes) : number<std::uint32_t>(bytes))
                                : (type.is_signed ? number<std::int64_t>(bytes) : number<std::uint64_t>(bytes));
    }

    template <class Number>
    static double number(const unsigned char* bytes) {
        Number value;
        std::memcpy(&value, bytes, sizeof value);
        return static_cast<double>(value);
    }

    PlyFormat format_;
    std::string_view whole_, rest_;
    const std::string& file_;
};

std::size_t list_length(PlyNumbers& numbers, const PlyProperty& property) {
    const double length = numbers.next(*property.count);
    if (!(length >= 0.0) || length != std::floor(length) ||
        length * static_cast<double>(numbers.least_bytes(property.type)) > static_cast<double>(numbers.bytes_left()))
        numbers.refuse("a list is longer than the file, or has no length");
    return static_cast<std::size_t>(length);
}

void skip(PlyNumbers& numbers, const PlyProperty& property) {
    const std::size_t count = property.count ? list_length(numbers, property) : 1;
    for (std::size_t n = 0; n < count; ++n) numbers.next(property.type);
}

void read_vertex(PlyNumbers& numbers, const PlyElement& element, PolygonMesh& mesh) {
    double place[3];
    std::fill(place, place + 3, std::numeric_limits<double>::quiet_NaN());
    for (const PlyProperty& property : element.properties) {
        const bool is_coordinate = property.name.size() == 1 && property.name >= "x" && property.name <= "z";
        if (is_coordinate && !property.count)
            place[property.name[0] - 'x'] = numbers.next(property.type);
        else
            skip(numbers, property);
    }
    for (const double coordinate : place)
        if (!std::isfinite(coordinate))
            throw InputError(numbers.where() + ": vertex " + std::to_string(mesh.vertex_count()) +
                             ": expected three finite coordinates");
    mesh.positions.insert(mesh.positions.end(), place, place + 3);
}

bool is_index_list(const PlyProperty& property) {
    return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
}

std::vector<std::int64_t> read_indices(PlyNumbers& numbers, const PlyElement& element) {
    std::vector<std::int64_t> indices;
    for (const PlyProperty& property : element.properties) {
        if (!is_index_list(property)) {
            skip(numbers, property);
            continue;
        }
        indices.resize(list_length(numbers, property));
        for (std::int64_t& vertex : indices) {
            const double index = numbers.next(property.type);
            if (!(std::abs(index) <= 0x1p32) || index != std::floor(index))
                numbers.refuse("a face's vertex is no whole number of 32 bits");
            vertex = static_cast<std::int64_t>(index);
        }
    }
    return indices;
}

void add_face(const std::vector<std::int64_t>& indices, PolygonMesh& mesh) {
    for (const std::int64_t vertex : indices) mesh.add_corner(vertex, vertex);
    mesh.end_face(mesh.faces.size());
}

bool has_property(const PlyElement& element, const char* name) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [name](const PlyProperty& property) { return !property.count && property.name == name; });
}

// Before a number is read.
void check_properties(const PlyHeader& header, const std::string& file) {
    for (const PlyElement& element : header.elements) {
        const bool has_corners = std::any_of(element.properties.begin(), element.properties.end(), is_index_list);
        if (element.count == 0) continue;
        if ((element.name == "face" || element.name == "tristrips") && !has_corners)
            refuse_ply(file, element.name + " without a list vertex_indices");
        for (const char* axis : {"x", "y", "z"})
            if (element.name == "vertex" && !has_property(element, axis))
                refuse_ply(file, std::string("vertex without a property ") + axis);
    }
}

// Every other triangle is turned round. Those that name a vertex twice only lead the strip on.
void add_strips(const std::vector<std::int64_t>& indices, PolygonMesh& mesh) {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        if (indices[k] == -1) begin = k + 1;
        if (k < begin + 2) continue;
        std::int64_t a = indices[k - 2], b = indices[k - 1];
        const std::int64_t c = indices[k];
        if (a == b || b == c || c == a) continue;
        if ((k - begin) % 2 == 1) std::swap(a, b);
        add_face({a, b, c}, mesh);
    }
}

}  // namespace

PolygonMesh read_ply(std::string_view contents, const std::string& file) {
    const std::string_view whole = contents;
    const PlyHeader header = take_ply_header(contents, file);
    check_properties(header, file);
    PlyNumbers numbers(header.format, contents, whole, file);
    const bool has_faces = std::any_of(header.elements.begin(), header.elements.end(), [](const PlyElement& element) {
        return element.name == "face" && element.count > 0;
    });
    PolygonMesh mesh;
    mesh.file = file;
    for (const PlyElement& element : header.elements) {
        if (element.name == "tristrips" && element.count > 0 && has_faces)
            mesh.warnings.push_back(file + ": triangle strips beside faces: " + std::to_string(element.count) +
                                    "; they are left out, taken for the same surface");
        // An element without properties takes no room in the file: its count bounds nothing and is not gone through.
        for (std::uint64_t n = 0; n < element.count && !element.properties.empty(); ++n) {
            if (element.name == "vertex")
                read_vertex(numbers, element, mesh);
            else if (element.name == "face")
                add_face(read_indices(numbers, element), mesh);
            else if (element.name == "tristrips" && !has_faces)
                add_strips(read_indices(numbers, element), mesh);
            else
                for (const PlyProperty& property : element.properties) skip(numbers, property);
        }
    }
    numbers.check_end();
    check_faces(mesh);  // at the end, for the faces may come before the vertices
    return mesh;
}

}  // namespace apsl::scenes
