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

std::pair<std::string, double> parse_feature_value(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw Error(ErrorCode::usage, option + " takes FEATURE=VALUE, is '" + text + "'", "",
                "e.g. " + option + " prominence=300");
  const std::string feature = text.substr(0, equals);
  return {feature, parse_number(option + " " + feature, text.substr(equals + 1))};
}

}  // namespace waymark::workflows
