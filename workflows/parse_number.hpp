// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
namespace waymark::workflows {

/// Returns the finite number that fills the whole word. Throws Error{usage}: "<what> must be a number, is
/// 'ten'".
double parse_number(const std::string& what, const std::string& word);

/// Returns the whole number that fills the word. Throws Error{usage} like parse_number().
std::int64_t parse_integer(const std::string& what, const std::string& word);

/// Returns name and value of "prominence=300", given by `option`. Throws Error{usage} for other texts.
std::pair<std::string, double> parse_feature_value(const std::string& option, const std::string& text);

}  // namespace waymark::workflows
