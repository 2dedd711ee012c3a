// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
namespace waymark {

/// The text of geodb/sql/<name>.sql, compiled in.
std::string_view sql_text(std::string_view name);

/// `text` with every {key} replaced by its value. Values are identifiers and time stamps of ours, never
/// input.
std::string fill_in(std::string_view text,
                    std::initializer_list<std::pair<std::string_view, std::string_view>> values);

/// An identifier in double quotes, as SQL wants it; quotes inside are doubled.
std::string sql_name(std::string_view identifier);

}  // namespace waymark
