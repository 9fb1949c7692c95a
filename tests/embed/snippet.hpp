// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

#include <vector>

apsl::StrainLimiter make_limiter(cl_context context, cl_device_id device, const std::vector<apsl::Triangle>& triangles,
                                 std::size_t vertex_count);
apsl::Stats limit_strain(apsl::StrainLimiter& limiter, cl_command_queue queue, cl_mem positions, cl_mem velocities,
                         cl_mem inverse_masses, cl_mem rest_areas);
