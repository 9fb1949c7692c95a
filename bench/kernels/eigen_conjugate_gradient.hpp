// SPDX-License-Identifier: MIT
#pragma once

#include "pressure_system.hpp"

#include <apsl/export.hpp>

namespace apsl::bench {

/// Eigen's ConjugateGradient, float, Jacobi preconditioner, over the whole (not half of the) row-major matrix: the form
/// that Eigen's documentation names as its fastest and multi-threaded one. `system` must outlive the result.
APSL_API Solve eigen_conjugate_gradient(const PressureSystem& system, int threads);

/// Threads that OpenMP gives Eigen on this machine.
APSL_API int eigen_thread_count();

}  // namespace apsl::bench
