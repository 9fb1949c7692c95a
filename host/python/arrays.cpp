// SPDX-License-Identifier: MIT
#include "arrays.hpp"

#include "finite.hpp"
#include "values.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace apsl::python {
namespace {

constexpr const char* real_kinds = "fiu";
constexpr const char* integer_kinds = "iu";

std::string shape_text(const py::array& array) {
    return py::repr(array.attr("shape"));
}

// The argument as it is, once its kind and shape are as they must be. 0 `columns`: an array of one dimension.
py::array checked(py::handle argument, const char* name, const std::string& kinds, std::optional<std::size_t> rows,
                  const char* row_name, std::size_t columns) {
    const auto array = py::array::ensure(argument);
    const std::string what = kinds == integer_kinds ? "an array of integers" : "an array of real numbers";
    if (!array) {
        PyErr_Clear();
        refuse(name, py::str(py::type::handle_of(argument).attr("__name__")), what);
    }
    // Of an empty list numpy makes real numbers.
    if (array.size() > 0 && kinds.find(array.dtype().kind()) == std::string::npos)
        refuse(name, "dtype " + std::string(py::str(array.dtype())), what);
    const bool right_columns =
        columns > 0 ? array.ndim() == 2 && static_cast<std::size_t>(array.shape(1)) == columns : array.ndim() == 1;
    if (!right_columns || (rows && static_cast<std::size_t>(array.shape(0)) != *rows)) {
        refuse(name, "shape " + shape_text(array),
               "(" + (rows ? std::to_string(*rows) : std::string(row_name)) +
                   (columns > 0 ? ", " + std::to_string(columns) + ")" : std::string(",)")));
    }
    return array;
}

// Numbers as `Value`. numpy would make infinity, and a warning, of one that 32 bits do not hold.
template <class Value>
Array<Value> converted(const py::array& given, const char* name) {
    using Converted = py::array_t<Value, py::array::c_style | py::array::forcecast>;
    if (std::is_same_v<Value, double> || given.dtype().kind() != 'f' || given.itemsize() <= 4) return Converted(given);
    const py::array_t<double, py::array::c_style | py::array::forcecast> wide(given);
    const py::ssize_t columns = wide.ndim() > 1 ? wide.shape(1) : 1;
    Converted narrow(std::vector<py::ssize_t>(wide.shape(), wide.shape() + wide.ndim()));
    for (py::ssize_t n = 0; n < wide.size(); ++n) {
        const double number = wide.data()[n];
        narrow.mutable_data()[n] = static_cast<Value>(number);
        if (is_finite(number) && !is_finite(narrow.data()[n]))
            refuse(name, std::string(py::repr(py::float_(number))) + " in row " + std::to_string(n / columns),
                   "numbers that 32 bits hold, at most 3.4e38");
    }
    return narrow;
}

}  // namespace

template <class Value>
Array<Value> numbers(py::handle argument, const char* name, std::optional<std::size_t> rows) {
    return converted<Value>(checked(argument, name, real_kinds, rows, "triangles", 0), name);
}

template <class Value>
Array<Value> table(py::handle argument, const char* name, std::optional<std::size_t> rows, std::size_t columns) {
    return converted<Value>(checked(argument, name, real_kinds, rows, "triangles", columns), name);
}

template <class Value>
Array<Value> vectors(py::handle argument, const char* name, std::optional<std::size_t> rows) {
    return converted<Value>(checked(argument, name, real_kinds, rows, "vertices", 3), name);
}

template Array<float> numbers<float>(py::handle, const char*, std::optional<std::size_t>);
template Array<double> numbers<double>(py::handle, const char*, std::optional<std::size_t>);
template Array<float> table<float>(py::handle, const char*, std::optional<std::size_t>, std::size_t);
template Array<float> vectors<float>(py::handle, const char*, std::optional<std::size_t>);
template Array<double> vectors<double>(py::handle, const char*, std::optional<std::size_t>);

Array<std::uint32_t> indices(py::handle argument, const char* name, const char* row, std::optional<std::size_t> rows,
                             std::size_t columns) {
    const py::array given = checked(argument, name, integer_kinds, rows, (std::string(row) + "s").c_str(), columns);
    if (given.dtype().kind() == 'u' && given.itemsize() <= 4) return Array<std::uint32_t>(given);
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(given);
    Array<std::uint32_t> narrow(std::vector<py::ssize_t>(wide.shape(), wide.shape() + wide.ndim()));
    for (py::ssize_t n = 0; n < wide.size(); ++n) {
        const std::int64_t vertex = wide.data()[n];
        if (vertex < 0 || vertex > std::numeric_limits<std::uint32_t>::max())
            refuse(name,
                   "vertex " + std::to_string(vertex) + " in " + row + " " +
                       std::to_string(static_cast<std::size_t>(n) / std::max<std::size_t>(columns, 1)),
                   "0 to 4294967295");
        narrow.mutable_data()[n] = static_cast<std::uint32_t>(vertex);
    }
    return narrow;
}

std::vector<Triangle> triangle_list(py::handle argument) {
    const Array<std::uint32_t> corners = indices(argument, "triangles", "triangle", std::nullopt, 3);
    const auto index = corners.unchecked<2>();
    std::vector<Triangle> triangles(static_cast<std::size_t>(corners.shape(0)));
    for (py::ssize_t t = 0; t < corners.shape(0); ++t)
        triangles[static_cast<std::size_t>(t)] = {index(t, 0), index(t, 1), index(t, 2)};
    return triangles;
}

}  // namespace apsl::python
