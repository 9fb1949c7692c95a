// SPDX-License-Identifier: MIT
#pragma once

#include "support/thorough.hpp"

#include <apsl/strain_limiter.hpp>

#include <vector>

namespace apsl::test {

/// Every set of kernels a call can be made of.
inline constexpr Options variants[] = {
    {.matrix = Matrix::consistent, .apply = Apply::assembled_csr, .execution = Execution::many_groups},
    {.matrix = Matrix::consistent, .apply = Apply::matrix_free, .execution = Execution::many_groups},
    {.matrix = Matrix::printed, .apply = Apply::assembled_csr, .execution = Execution::many_groups},
    {.matrix = Matrix::printed, .apply = Apply::matrix_free, .execution = Execution::many_groups},
    {.matrix = Matrix::consistent, .apply = Apply::matrix_free, .execution = Execution::one_group}};

/// Of these the two that share no kernel; thorough() all.
inline std::vector<Options> compared_variants() {
    if (thorough()) return {std::begin(variants), std::end(variants)};
    return {variants[0], variants[4]};
}

}  // namespace apsl::test
