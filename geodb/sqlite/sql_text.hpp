// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
namespace waymark::geodb {

/// Returns the text of geodb/sql/<name>.sql, which is compiled in.
std::string_view sql_text(std::string_view name);

/// Replaces every {key} in `text` by its value. Values are internal identifiers and time stamps, never user
/// input.
std::string substitute_keys(std::string_view text,
                            std::initializer_list<std::pair<std::string_view, std::string_view>> values);

/// Quotes an SQL identifier; quotes inside are doubled.
std::string quote_identifier(std::string_view identifier);

}  // namespace waymark::geodb
