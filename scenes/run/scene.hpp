// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/colliders.hpp"
#include "pipeline/pins.hpp"
#include "run/make_mesh.hpp"
#include "run/read_mesh.hpp"

#include <apsl/options.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace apsl::scenes {

using MeshSource = std::variant<GridMesh, TubeMesh, MeshFile>;

struct SelectedVertices {
    std::vector<std::uint32_t> vertices;
};

/// Corners of the mesh's bounding box, such as "min_x_max_y": the vertex nearest to the corner, seen along the axes
/// that are not named.
struct SelectedCorners {
    std::vector<std::string> corners;
};

/// Every vertex inside, faces included.
struct SelectedBox {
    std::array<double, 3> min{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};  ///< m
    std::array<double, 3> max{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};  ///< m
};

/// Vertices, before the mesh is known.
using VertexSelection = std::variant<SelectedVertices, SelectedCorners, SelectedBox>;

/// Which vertices are pinned and how they move.
struct Pin {
    VertexSelection selection;
    Motion motion;
};

/// Vertices heavier or lighter than their triangles make them.
struct MassFactor {
    VertexSelection selection;
    double factor = 1.0;  ///< > 0
};

/// How the cloth is when the first step begins; springs are at rest where the mesh has them, and so are areas but for
/// `rest_areas`.
struct Start {
    std::array<double, 3> scale{1.0, 1.0, 1.0};  ///< about the mean of the mesh's vertices: 0 collapses, −1 mirrors
    double random = 0.0;                         ///< m, ≥ 0: each is then moved by up to this along each axis
    double rest_areas = 1.0;                     ///< > 0, times the mesh's: what the limiter is to hold; masses stay
};

/// Gravity alone moves the cloth ahead of the filter.
struct NoIntegrator {};

/// Backward Euler on springs (pipeline/implicit_springs.hpp).
struct ImplicitSpringsIntegrator {
    double stretch_stiffness = 20.0;  ///< N/m, ≥ 0
    double bend_stiffness = 0.01;     ///< N/m, ≥ 0
    double damping = 0.5;             ///< 1/s, ≥ 0
};

/// Section 6 of the paper: bending springs, and the filter holds the rest (pipeline/springs.hpp).
struct BendingSpringsIntegrator {
    double bend_stiffness = 200.0;  ///< N/m, ≥ 0
    double damping = 0.5;           ///< 1/s, ≥ 0
};

/// The limiter takes whole steps, with nothing in front of it: StrainLimiting::options integrates then, with gravity
/// and this damping among its parameters, keeps contacts where there are colliders, and bends where there is a
/// rigidity.
struct StandAloneIntegrator {
    double damping = 0.5;  ///< 1/s, ≥ 0
    double bending = 0.0;  ///< N·m, ≥ 0
    /// 0 to 10⁶: tethers to the pins, this times as long as the way there at rest. 0: none.
    double tethers = 1.0;
};

using Integrator =
    std::variant<NoIntegrator, ImplicitSpringsIntegrator, BendingSpringsIntegrator, StandAloneIntegrator>;

struct StrainLimiting {
    Options options;
    Parameters parameters;                ///< time_step is the scene's
    std::vector<float> regularization;    ///< α ≥ 1, [T], with Options::regularization_per_triangle
    std::vector<float> stretch_ceilings;  ///< 0 or ≥ 1.01, [T]; read with Options::stretch_ceiling_per_triangle
    float tethers = 0.0f;                 ///< as StandAloneIntegrator has it

    bool operator==(const StrainLimiting&) const = default;
};

/// A scene file as read: what it names and nothing more. SI units.
struct Scene {
    std::string file;  ///< as named by the user, for messages
    MeshSource mesh;
    double density = 0.2;  ///< kg/m², > 0
    std::vector<Pin> pins;
    std::vector<MassFactor> masses;  ///< a vertex that several select takes them all
    Start start;
    std::array<double, 3> gravity{0.0, -9.81, 0.0};  ///< m/s²
    double time_step = 1.0 / 60.0;                   ///< s, > 0
    int steps_per_frame = 1;                         ///< ≥ 1
    int frames = 180;                                ///< ≥ 1
    Integrator integrator;
    std::optional<StrainLimiting> strain_limiting;
    std::vector<MovingCollider> colliders;
};

}  // namespace apsl::scenes
