// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Included by every C++ header: an older C++ stops here, in one line.

#if defined(_MSVC_LANG) ? _MSVC_LANG < 202002L : __cplusplus < 202002L
#error "apsl needs C++20: compile with -std=c++20, or include <apsl/apsl.h>, the C interface"
#include <apsl/needs_cxx20>  // is not there: the compiler ends here
#endif
