/* SPDX-License-Identifier: MIT */
#pragma once

/** @file
 * The one place the version is written; CMakeLists.txt reads it from here. Semantic versioning, https://semver.org: no
 * 1.x breaks the sources of a program that uses an earlier one. Binaries that use the C interface keep running, those
 * that use the C++ interface are to be built again with each minor version. */

/** Raised where programs must change. */
#define APSL_VERSION_MAJOR 1
/** Raised where something is new. */
#define APSL_VERSION_MINOR 0
/** Raised for corrections alone. */
#define APSL_VERSION_PATCH 0
/** The headers' version as one number, 10000 major + 100 minor + patch. */
#define APSL_VERSION_NUMBER (10000 * APSL_VERSION_MAJOR + 100 * APSL_VERSION_MINOR + APSL_VERSION_PATCH)

/** C++ structs whose fields may grow lie in an inline namespace named after the minor version. A program built with the
 * headers of another one then does not link, where it would otherwise misread them. */
#define APSL_STRUCTS_BEGIN inline namespace v1_0 {
/** Ends what APSL_STRUCTS_BEGIN began. */
#define APSL_STRUCTS_END }
