// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace apsl::scenes {

/// Takes the next line off `rest`, without its end: \n, \r\n or \r.
inline std::string_view take_line(std::string_view& rest) {
    const std::size_t end = rest.find_first_of("\r\n");
    const std::string_view line = rest.substr(0, end);
    if (end == std::string_view::npos)
        rest = {};
    else
        rest.remove_prefix(end + (rest.substr(end).starts_with("\r\n") ? 2 : 1));
    return line;
}

/// Takes the next word off `rest`; empty where there is none. Words lie between the characters of `blanks`.
inline std::string_view take_word(std::string_view& rest, std::string_view blanks = " \t") {
    const std::size_t begin = rest.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return rest = {};
    rest.remove_prefix(begin);
    const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
    rest.remove_prefix(word.size());
    return word;
}

/// For messages: in quotation marks, without control characters, and not all of a megabyte.
inline std::string quoted(std::string_view text) {
    std::string shown = "\"";
    for (const char letter : text.substr(0, 60)) {
        const auto code = static_cast<unsigned char>(letter);
        shown += code < 0x20 || code == 0x7f ? '?' : letter;
    }
    return shown.append(text.size() > 60 ? "...\"" : "\"");
}

/// For messages and tables: three digits.
inline std::string short_number(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", number);
    return text;
}

/// The number that all of the word is; false where it is none. Whole ones out of Number's range are none; others
/// become 0 or infinite, as by strtod.
template <class Number>
bool parse_number(std::string_view word, Number& number) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const char* const word_end = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), word_end, number);
    if constexpr (std::is_same_v<Number, double>) {
        // from_chars does not say on which side of the range it is.
        if (error == std::errc::result_out_of_range) number = std::strtod(std::string(word).c_str(), nullptr);
        return error != std::errc::invalid_argument && end == word_end;
    }
    return error == std::errc{} && end == word_end;
}

}  // namespace apsl::scenes
