// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

#include <filesystem>

apsl::StrainLimiter start(cl_context context, cl_device_id device, const std::shared_ptr<const apsl::Topology>& cloth,
                          const std::filesystem::path& path);
void keep_program(const apsl::StrainLimiter& limiter, const std::filesystem::path& path);
