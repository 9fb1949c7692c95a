// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <string>
#include <string_view>

namespace apsl::scenes {

/// The text behind a UTF-8 byte order mark, where there is one. Throws InputError for text in UTF-16.
inline std::string_view without_byte_order_mark(std::string_view text, const std::string& file) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        throw InputError(file + ": is text in UTF-16, expected UTF-8 or ASCII");
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    return text;
}

}  // namespace apsl::scenes
