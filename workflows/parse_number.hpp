// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
namespace waymark::workflows {

/// Returns the finite number that fills the whole word. Throws Error{usage}: "<what> must be a number, is
/// 'ten'".
double parse_number(const std::string& what, const std::string& word);

/// Returns the whole number that fills the word. Throws Error{usage} like parse_number().
std::int64_t parse_integer(const std::string& what, const std::string& word);

}  // namespace waymark::workflows
