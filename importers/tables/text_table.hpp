// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::importers {

/// A row of a text file as words.
struct TextRow {
  std::size_t line = 0;  ///< from 1
  std::vector<std::string> words;
};

/// Reads the rows of a text file without empty ones and comments (#). Words are separated by commas,
/// semicolons, tabs or blanks; single or double quotes enclose words.
std::vector<TextRow> text_rows(const std::string& path);

/// Parses a word that is a number as a whole, independent of the locale. Returns false for other text.
bool parse_number(std::string_view word, double& value);

/// Throws Error{input} with file and line.
[[noreturn]] void refuse_line(const std::string& path, std::size_t line, const std::string& problem,
                              const std::string& hint = {});

/// Returns the word at `index` as a finite number. Throws Error{input} with the line otherwise.
double number_at(const TextRow& row, std::size_t index, const std::string& path, const char* name);

}  // namespace waymark::importers
