// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/topology.hpp>

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The literature's baselines: for comparison only, never installed.
namespace apsl::methods {

/// What a method may know of a cloth before it starts. Copied from where needed: none of it changes during a run.
struct Cloth {
    std::shared_ptr<const Topology> topology;
    std::vector<Eigen::Vector3d> rest_positions;  ///< m, [V]
    std::vector<double> rest_areas;               ///< m², [T]
    std::vector<double> inverse_masses;           ///< 1/kg, [V], 0 for pinned vertices
    double time_step = 1.0 / 60.0;                ///< s, > 0
};

/// One of a method's quality settings, by the name that its table entry gives it.
struct Parameter {
    std::string name;
    double value = 0.0;
};

/// A limiter without a memory: what it holds between calls follows from cloth and parameters alone.
class Method {
public:
    virtual ~Method() = default;

    /// Moves the predicted positions x̃ + Δt ṽ (m, [V]) towards the method's constraints. Pinned vertices keep their
    /// bits. Positions that are not finite may come out as anything; nothing crashes or hangs.
    virtual void project(std::span<Eigen::Vector3f> positions) = 0;
};

/// A parameter, the value it has where none is given, and the values of the standard sweep, from coarse to fine.
struct ParameterInfo {
    std::string name;
    double standard = 0.0;
    double least = 0.0;
    std::vector<double> sweep;
};

struct MethodInfo {
    std::string name;      ///< as in `apsl compare --methods`: pbd_edges
    std::string title;     ///< on charts: PBD edges
    std::string citation;  ///< Müller et al. 2007
    std::vector<ParameterInfo> parameters;
    /// `values`: one for each of `parameters`, in their order.
    std::function<std::unique_ptr<Method>(const Cloth& cloth, std::span<const double> values)> make;
};

/// All baselines. A scene's own integrator without any limiter is not among them.
std::span<const MethodInfo> all_methods();

/// Throws Error(invalid_argument) naming what is unknown (with the known names) or out of range.
std::unique_ptr<Method> make_method(std::string_view name, const Cloth& cloth, std::span<const Parameter> parameters);

}  // namespace apsl::methods
