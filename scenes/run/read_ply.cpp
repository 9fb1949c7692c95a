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
    PlyNumbers(PlyFormat format, std::string_view contents, const std::string& file)
        : format_(format), rest_(contents), file_(file) {}

    double next(const PlyType& type) { return format_ == PlyFormat::ascii ? next_word() : next_bytes(type); }

    /// Text has a line end behind its last number and nothing else; who counted wrong left faces out.
    void check_end() {
        const std::string_view word = format_ == PlyFormat::ascii ? take_word(rest_, kBlanks) : std::string_view{};
        if (!word.empty()) refuse_ply(file_, "goes on behind what its header counts, with " + quoted(word));
    }

    /// The least that a number takes: what bounds every count by the size of the file.
    std::size_t least_bytes(const PlyType& type) const { return format_ == PlyFormat::ascii ? 1 : type.size; }
    std::size_t bytes_left() const { return rest_.size(); }

private:
    static constexpr std::string_view kBlanks = " \t\r\n";

    double next_word() {
        const std::string_view word = take_word(rest_, kBlanks);
        double number = 0.0;
        if (word.empty()) refuse_ply(file_, "ends before its last number");
        if (!parse_number(word, number)) refuse_ply(file_, "expected a number, got " + quoted(word));
        return number;
    }

    double next_bytes(const PlyType& type) {
        if (rest_.size() < type.size) refuse_ply(file_, "ends before its last number");
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
    std::string_view rest_;
    const std::string& file_;
};

std::size_t list_length(PlyNumbers& numbers, const PlyProperty& property, const std::string& file) {
    const double length = numbers.next(*property.count);
    if (!(length >= 0.0) || length != std::floor(length) ||
        length * static_cast<double>(numbers.least_bytes(property.type)) > static_cast<double>(numbers.bytes_left()))
        refuse_ply(file, "a list is longer than the file, or has no length");
    return static_cast<std::size_t>(length);
}

void skip(PlyNumbers& numbers, const PlyProperty& property, const std::string& file) {
    const std::size_t count = property.count ? list_length(numbers, property, file) : 1;
    for (std::size_t n = 0; n < count; ++n) numbers.next(property.type);
}

void read_vertex(PlyNumbers& numbers, const PlyElement& element, const std::string& file, PolygonMesh& mesh) {
    double place[3];
    std::fill(place, place + 3, std::numeric_limits<double>::quiet_NaN());
    for (const PlyProperty& property : element.properties) {
        const bool is_coordinate = property.name.size() == 1 && property.name >= "x" && property.name <= "z";
        if (is_coordinate && !property.count)
            place[property.name[0] - 'x'] = numbers.next(property.type);
        else
            skip(numbers, property, file);
    }
    for (const double coordinate : place)
        if (!std::isfinite(coordinate))
            throw InputError(file + ": vertex " + std::to_string(mesh.vertex_count()) +
                             ": expected three finite coordinates");
    mesh.positions.insert(mesh.positions.end(), place, place + 3);
}

std::vector<std::int64_t> read_indices(PlyNumbers& numbers, const PlyElement& element, const std::string& file) {
    std::vector<std::int64_t> indices;
    bool found = false;
    for (const PlyProperty& property : element.properties) {
        if (!property.count || (property.name != "vertex_indices" && property.name != "vertex_index")) {
            skip(numbers, property, file);
            continue;
        }
        found = true;
        indices.resize(list_length(numbers, property, file));
        for (std::int64_t& vertex : indices) {
            const double index = numbers.next(property.type);
            if (!(std::abs(index) <= 0x1p32) || index != std::floor(index))
                refuse_ply(file, "a face's vertex is no whole number of 32 bits");
            vertex = static_cast<std::int64_t>(index);
        }
    }
    if (!found) refuse_ply(file, element.name + " without a list vertex_indices");
    return indices;
}

void add_face(const std::vector<std::int64_t>& indices, PolygonMesh& mesh) {
    for (const std::int64_t vertex : indices) mesh.add_corner(vertex, vertex);
    mesh.end_face(mesh.faces.size());
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
    const PlyHeader header = take_ply_header(contents, file);
    PlyNumbers numbers(header.format, contents, file);
    const bool has_faces = std::any_of(header.elements.begin(), header.elements.end(), [](const PlyElement& element) {
        return element.name == "face" && element.count > 0;
    });
    PolygonMesh mesh;
    mesh.file = file;
    for (const PlyElement& element : header.elements) {
        // An element without properties takes no room in the file: its count bounds nothing and is not gone through.
        for (std::uint64_t n = 0; n < element.count && !element.properties.empty(); ++n) {
            if (element.name == "vertex")
                read_vertex(numbers, element, file, mesh);
            else if (element.name == "face")
                add_face(read_indices(numbers, element, file), mesh);
            else if (element.name == "tristrips" && !has_faces)
                add_strips(read_indices(numbers, element, file), mesh);
            else
                for (const PlyProperty& property : element.properties) skip(numbers, property, file);
        }
    }
    numbers.check_end();
    check_faces(mesh);  // at the end, for the faces may come before the vertices
    return mesh;
}

}  // namespace apsl::scenes
