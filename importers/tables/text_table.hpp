// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>
namespace waymark {

/// A row of a text file, split into words.
struct TextRow {
  std::size_t line = 0;  ///< from 1
  std::vector<std::string> words;
};

/// Rows of a text file without empty ones and comments (#). Words are separated by commas, semicolons, tabs
/// or blanks; quotes, single or double, hold words together.
std::vector<TextRow> text_rows(const std::string& path);

/// A word as a number; nothing else may follow it. Locale has no say.
bool parse_number(std::string_view word, double& value);

/// Throws Error{input} that names file and line.
[[noreturn]] void refuse_line(const std::string& path, std::size_t line, const std::string& problem,
                              const std::string& hint = {});

/// The word at `index` as a finite number; refuses the line where it is none.
double number_at(const TextRow& row, std::size_t index, const std::string& path, const char* name);

}  // namespace waymark
