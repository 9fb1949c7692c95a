// SPDX-License-Identifier: MIT
#pragma once

#include "accuracy.hpp"
#include "cloth.hpp"
#include "device.hpp"
#include "results.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace apsl::bench {

/// What the benchmarks of one run share. They run one after another, cloth by cloth, so that only the present cloth
/// and its double-precision matrix are held.
struct Run {
    Device device;
    Results results;
    int repetitions = 15;  ///< about the number of samples of a benchmark
    bool failed = false;   ///< a benchmark ended with an error
};

struct Subject {
    std::string name;  ///< "65x65", or the file's name without ending
    Mesh mesh;
    /// All peers; otherwise ours and Eigen's CG alone.
    bool all_peers = true;
};

/// Registers with Google Benchmark all that is measured on one cloth: our filter call, its kernels and a CG iteration,
/// for both ways to apply the matrix, and the peers.
void register_cloth(Run& run, const Subject& subject);

/// Registers the filter call over `copies` grids of 33 × 33 vertices, and over one cloth of as many triangles.
void register_cloths(Run& run, std::size_t copies);

}  // namespace apsl::bench
