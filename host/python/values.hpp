// SPDX-License-Identifier: MIT
#pragma once

#include "stats_fields.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <type_traits>

// Structs to and from Python by their tables of fields.
namespace apsl::python {

namespace py = pybind11;

[[noreturn]] inline void refuse(const std::string& argument, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::invalid_argument, argument + ": got " + got + ", expected " + expected);
}

/// A string for an enumeration, a number or a bool for the rest.
template <class Value>
py::object to_python(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
        for (const auto& [entry, name] : names_of<Value>)
            if (entry == value) return py::str(name);
        throw Error(ErrorCode::unsupported, "apsl: the Python module has no name for value " +
                                                std::to_string(static_cast<int>(value)) + " of an enumeration");
    } else {
        return py::cast(value);
    }
}

/// Of a numpy scalar, or an array without dimensions, the number that it holds, of a type of Python's.
inline py::object without_numpy(py::handle object) {
    const bool scalar = py::hasattr(object, "item") && py::hasattr(object, "ndim") &&
                        py::object(object.attr("ndim")).equal(py::int_(0));
    return scalar ? py::object(object.attr("item")()) : py::reinterpret_borrow<py::object>(object);
}

/// Throws Error(invalid_argument) that names the argument for a value of another type or out of the type's range.
template <class Value>
Value from_python(py::handle given, const std::string& argument) {
    const py::object object = without_numpy(given);
    const std::string got = py::repr(object);  // numpy 2 would say np.int64(1)
    if constexpr (std::is_enum_v<Value>) {
        std::string expected;
        for (const auto& [value, name] : names_of<Value>) {
            if (py::isinstance<py::str>(object) && object.cast<std::string>() == name) return value;
            expected += (expected.empty() ? "'" : ", '") + std::string(name) + "'";
        }
        refuse(argument, got, "one of " + expected);
    } else if constexpr (is_vector<Value>) {
        Value vector;
        const bool is_list = py::isinstance<py::sequence>(object) || py::hasattr(object, "__array__");
        if (!is_list || py::len(object) != vector.size()) refuse(argument, got, "three numbers");
        for (std::size_t k = 0; k < vector.size(); ++k)
            vector[k] =
                from_python<typename Value::value_type>(object[py::int_(k)], argument + "[" + std::to_string(k) + "]");
        return vector;
    } else {
        constexpr bool is_bool = std::is_same_v<Value, bool>;
        constexpr const char* expected = is_bool                           ? "True or False"
                                         : std::is_floating_point_v<Value> ? "a number"
                                         : std::is_unsigned_v<Value>       ? "an integer from 0 to 4294967295"
                                                                           : "an integer of 32 bits";
        // pybind11 takes a bool to be a number, and an array of one number; it cuts off what follows a Decimal's point.
        const bool is_array = py::hasattr(object, "__len__");
        const bool is_whole = PyIndex_Check(object.ptr()) != 0;
        if (py::isinstance<py::bool_>(object) != is_bool || is_array || (std::is_integral_v<Value> && !is_whole))
            refuse(argument, got, expected);
        try {
            return object.cast<Value>();
        } catch (const py::cast_error&) {
            refuse(argument, got, expected);
        }
    }
}

template <class Struct, class... Fields>
py::dict to_dict(const Struct& values, const std::tuple<Fields...>& fields) {
    py::dict dict;
    std::apply([&](const auto&... field) { ((dict[field.name] = to_python(values.*field.member)), ...); }, fields);
    return dict;
}

/// `values` with what `arguments` names replaced. Throws TypeError for a name that no field has, as Python does.
template <class Struct, class... Fields>
Struct with_arguments(Struct values, const py::dict& arguments, const char* function,
                      const std::tuple<Fields...>& fields) {
    for (const auto& [key, object] : arguments) {
        const auto name = key.template cast<std::string>();
        bool known = false;
        std::string names;
        const auto take = [&, value = object](const auto& field) {
            names += (names.empty() ? "" : ", ") + std::string(field.name);
            if (name != field.name) return;
            known = true;
            using Value = std::remove_reference_t<decltype(values.*field.member)>;
            values.*field.member = from_python<Value>(value, name);
        };
        std::apply([&](const auto&... field) { (take(field), ...); }, fields);
        if (!known) {
            throw py::type_error(std::string(function) + "() got an unexpected keyword argument '" + name +
                                 "', expected " + names);
        }
    }
    return values;
}

}  // namespace apsl::python
