// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>
namespace waymark {

/// A whole file. Throws Error{input} where it cannot be read.
std::string text_of_file(const std::filesystem::path& file);

/// Numbers separated by blanks, commas or line ends; lines that begin with '#' or '%' are left out.
/// `per_row`: numbers in a row, whatever the lines are. Throws Error{input} naming the line of what is no
/// number, and for a last row that is not whole.
std::vector<double> number_table(const std::filesystem::path& file, std::size_t per_row);

}  // namespace waymark
