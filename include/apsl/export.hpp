/* SPDX-License-Identifier: MIT */
#pragma once

/** Marks what the shared library shows; everything else is hidden. */
#if defined(_WIN32)
#define APSL_API
#else
#define APSL_API __attribute__((visibility("default")))
#endif
