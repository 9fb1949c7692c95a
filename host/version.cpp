// SPDX-License-Identifier: MIT
#include <apsl/apsl.h>
#include <apsl/parameters.hpp>

#include <type_traits>

#define APSL_TEXT_OF(number) #number
#define APSL_TEXT(number) APSL_TEXT_OF(number)

#define APSL_INLINE_NAMESPACE_OF(major, minor) v##major##_##minor
#define APSL_INLINE_NAMESPACE(major, minor) APSL_INLINE_NAMESPACE_OF(major, minor)

static_assert(
    std::is_same_v<apsl::Parameters, apsl::APSL_INLINE_NAMESPACE(APSL_VERSION_MAJOR, APSL_VERSION_MINOR)::Parameters>,
    "APSL_STRUCTS_BEGIN names another version");

const char* apsl_version(void) {
    return APSL_TEXT(APSL_VERSION_MAJOR) "." APSL_TEXT(APSL_VERSION_MINOR) "." APSL_TEXT(APSL_VERSION_PATCH);
}

int32_t apsl_version_number(void) {
    return APSL_VERSION_NUMBER;
}
