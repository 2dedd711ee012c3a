// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::importers {

/// Reads numbers separated by blanks, commas or line ends; skips lines that begin with '#' or '%'. `per_row`
/// is the count of numbers in a row, whatever the lines are. Throws Error{input} with the line for an invalid
/// number, and for an incomplete last row.
std::vector<double> number_table(const std::filesystem::path& file, std::size_t per_row);

}  // namespace waymark::importers
