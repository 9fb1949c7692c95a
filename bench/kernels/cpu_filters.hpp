// SPDX-License-Identifier: MIT
//
// The whole filter on the CPU, in float, for comparison. Both begin with ṽ = 0 and leave ṽ (m/s, [3V]).
#pragma once

#include "cloth.hpp"

#include <apsl/parameters.hpp>

#include <functional>
#include <vector>

namespace apsl::bench {

using Filter = std::function<std::vector<float>(const Parameters&)>;

/// apsl::reference::BasicStrainLimiter<float>: Eigen's matrix and vectors, one thread. `cloth` must outlive the result.
Filter reference_filter(const Cloth& cloth);

/// Algorithm 1 with every solve done exactly: Eigen's SimplicialLDLT, factorised anew in each sub-step, ordering and
/// symbolic factorisation (which the mesh alone decides) done beforehand. Takes no notice of max_iterations. `cloth`
/// must outlive the result. Throws std::runtime_error where a factorisation fails.
Filter direct_filter(const Cloth& cloth);

}  // namespace apsl::bench
