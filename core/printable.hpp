// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
namespace waymark::inline core {

/// Returns the bytes of the well-formed UTF-8 character at the begin of a text (Unicode 15, table 3-7); 0 if
/// there is none.
std::size_t utf8_length(std::string_view text);

/// Returns a text that is safe on a terminal. These become escapes such as \x1b: control characters but line
/// feed and tab, marks of the direction of writing, bytes that are not UTF-8. A text of more than `max_bytes`
/// is cut in its middle.
std::string printable(std::string_view text, std::size_t max_bytes = std::string_view::npos);

}  // namespace waymark::inline core
