// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <pybind11/numpy.h>

#include <cstdint>
#include <optional>
#include <vector>

// Arguments to arrays. Every function throws Error(invalid_argument) that names the argument, what was given and what
// was expected.
namespace apsl::python {

template <class Value>
using Array = pybind11::array_t<Value, pybind11::array::c_style>;

/// [rows] of real numbers of any size; any number of rows where `rows` is empty. The argument itself where it is such
/// an array of Value without gaps, else a converted copy. Value is float or double.
template <class Value>
Array<Value> numbers(pybind11::handle argument, const char* name, std::optional<std::size_t> rows);

/// Likewise [rows, columns].
template <class Value>
Array<Value> table(pybind11::handle argument, const char* name, std::optional<std::size_t> rows, std::size_t columns);

/// Likewise [rows, 3].
template <class Value>
Array<Value> vectors(pybind11::handle argument, const char* name, std::optional<std::size_t> rows);

/// [rows, columns] of vertices, [rows] for 0 columns: integers of any size that are valid in 32 bits. The argument
/// itself where it is such an array of 32 bits without sign and without gaps, else a converted copy. `row`: what a line
/// calls one. Whether each is a vertex of a mesh is not looked at.
Array<std::uint32_t> indices(pybind11::handle argument, const char* name, const char* row,
                             std::optional<std::size_t> rows, std::size_t columns);

/// [T, 3] of integers of any size that are valid in 32 bits. Whether each is a vertex is the topology's to check.
std::vector<Triangle> triangle_list(pybind11::handle argument);

}  // namespace apsl::python
