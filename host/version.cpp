// SPDX-License-Identifier: MIT
#include <apsl/apsl.h>

#define APSL_TEXT_OF(number) #number
#define APSL_TEXT(number) APSL_TEXT_OF(number)

const char* apsl_version(void) {
    return APSL_TEXT(APSL_VERSION_MAJOR) "." APSL_TEXT(APSL_VERSION_MINOR) "." APSL_TEXT(APSL_VERSION_PATCH);
}

int32_t apsl_version_number(void) {
    return APSL_VERSION_NUMBER;
}
