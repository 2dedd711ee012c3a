// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/table_number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "core/lower_case.hpp"

namespace waymark::importers {
namespace {

std::string_view trimmed(std::string_view cell) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = cell.find_first_not_of(blanks);
  return first == std::string_view::npos ? std::string_view{}
                                         : cell.substr(first, cell.find_last_not_of(blanks) - first + 1);
}

}  // namespace

bool is_missing(std::string_view cell) {
  constexpr std::array<std::string_view, 8> words = {"na", "n/a", "nan", "null", "none", "-", "--", "*"};
  const std::string lower = lower_case(trimmed(cell));
  return lower.empty() || std::ranges::find(words, lower) != words.end();
}

std::optional<double> to_real(std::string_view cell, bool decimal_comma) {
  std::string_view digits = trimmed(cell);
  std::string with_point;
  if (decimal_comma && std::ranges::count(digits, ',') == 1 && digits.find('.') == std::string_view::npos) {
    with_point = digits;
    std::ranges::replace(with_point, ',', '.');
    digits = with_point;
  }
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  double value = 0;
  const auto [stop, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || fault != std::errc{} || stop != digits.data() + digits.size() ||
      !std::isfinite(value))
    return {};
  return value;
}

}  // namespace waymark::importers
