// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// The one place the version is written; CMakeLists.txt reads it from here. Semantic versioning, https://semver.org:
/// until 1.0 a minor version may break programs and binaries, a patch may not.

/// Raised where programs must change.
#define APSL_VERSION_MAJOR 0
/// Raised where something is new; until 1.0 also where programs must change.
#define APSL_VERSION_MINOR 1
/// Raised for corrections alone.
#define APSL_VERSION_PATCH 0
/// The headers' version as one number, 10000 major + 100 minor + patch.
#define APSL_VERSION_NUMBER (10000 * APSL_VERSION_MAJOR + 100 * APSL_VERSION_MINOR + APSL_VERSION_PATCH)
