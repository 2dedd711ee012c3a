// SPDX-License-Identifier: Apache-2.0
#include "workflows/parse_number.hpp"

#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace waymark::workflows {
namespace {

template <class Number>
Number number(const std::string& what, const std::string& word, const char* kind) {
  Number value{};
  const char* end = word.data() + word.size();
  const auto [stop, fault] = std::from_chars(word.data() + (word.starts_with('+') ? 1 : 0), end, value);
  if (fault != std::errc{} || stop != end || !std::isfinite(static_cast<double>(value)))
    throw Error(ErrorCode::usage, what + " must be a " + kind + ", is '" + word + "'");
  return value;
}

}  // namespace

double parse_number(const std::string& what, const std::string& word) {
  return number<double>(what, word, "number");
}

std::int64_t parse_integer(const std::string& what, const std::string& word) {
  return number<std::int64_t>(what, word, "whole number");
}

}  // namespace waymark::workflows
