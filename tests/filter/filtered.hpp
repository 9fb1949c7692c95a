// SPDX-License-Identifier: MIT
#pragma once

#include "support/device_cloth.hpp"

#include <apsl/parameters.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace apsl::test {

/// Every matrix, way to apply it and execution. Written out: on small meshes automatic execution is one_group.
constexpr std::array<Options, 5> variants{
    {{.matrix = Matrix::consistent, .apply = Apply::assembled_csr, .execution = Execution::many_groups},
     {.matrix = Matrix::consistent, .apply = Apply::matrix_free, .execution = Execution::many_groups},
     {.matrix = Matrix::printed, .apply = Apply::assembled_csr, .execution = Execution::many_groups},
     {.matrix = Matrix::printed, .apply = Apply::matrix_free, .execution = Execution::many_groups},
     {.matrix = Matrix::consistent, .apply = Apply::matrix_free, .execution = Execution::one_group}}};
/// Those of the consistent matrix, matrix-free.
constexpr Options many_groups = variants[1];
constexpr Options one_group = variants[4];

/// A polynomial in place of CG.
constexpr Options by_chebyshev{.execution = Execution::many_groups, .solver = Solver::chebyshev};

/// Work-items a group in which device and reference are compared: 64, thorough() 1 as well, which is what
/// most other tests run in (automatic on a CPU).
std::vector<std::uint32_t> compared_group_sizes();

/// One of each kind of small mesh.
std::vector<MovingCloth> small_cloths();
/// A square of n × n vertices, 1 m wide, flat and at rest, 0.2 kg/m², held at `pins`.
MovingCloth flat_sheet(std::uint32_t n, const std::vector<std::uint32_t>& pins);
std::vector<std::shared_ptr<const Topology>> topologies_of(const std::vector<MovingCloth>& cloths);

/// For messages: "printed, assembled, many groups of 64".
std::string variant_name(const Options& options);

/// What a call left of one cloth.
struct Filtered {
    std::vector<double> velocities;  ///< m/s, [3V]
    Stats stats;
    std::vector<double> positions{};  ///< m, [3V], with Options::integrates
};

/// One call on a limiter of its own.
Filtered filter_on_device(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                          std::size_t offset = 0);
Filtered filter_with_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters);

/// Device against reference: velocities, statistics, and the statistics against areas in double precision.
void check_against_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                             std::size_t offset = 0);

void check_against_reference(const Filtered& got, const MovingCloth& cloth, const Options& options,
                             const Parameters& parameters);

/// max |A − A⁰| / A⁰ at the end of a step with these velocities, in double precision; rest areas ≤ 0 left out.
double max_area_change(const MovingCloth& cloth, const std::vector<double>& velocities, double time_step);

bool all_finite(const std::vector<double>& numbers);

/// max |v| over all coordinates.
double greatest(const std::vector<double>& numbers);

}  // namespace apsl::test
