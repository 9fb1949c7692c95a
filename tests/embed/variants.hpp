// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

namespace apsl::test {

/// Every set of kernels a call can be made of.
inline constexpr Options variants[] = {
    {.matrix = Matrix::consistent, .apply = Apply::assembled_csr, .execution = Execution::many_groups},
    {.matrix = Matrix::consistent, .apply = Apply::matrix_free, .execution = Execution::many_groups},
    {.matrix = Matrix::printed, .apply = Apply::assembled_csr, .execution = Execution::many_groups},
    {.matrix = Matrix::printed, .apply = Apply::matrix_free, .execution = Execution::many_groups},
    {.matrix = Matrix::consistent, .apply = Apply::matrix_free, .execution = Execution::one_group}};

}  // namespace apsl::test
