// SPDX-License-Identifier: MIT
#pragma once

// The one place the version is written; CMakeLists.txt reads it from here.
#define APSL_VERSION_MAJOR 0
#define APSL_VERSION_MINOR 1
#define APSL_VERSION_PATCH 0
