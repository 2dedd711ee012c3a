// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/printable.hpp"
namespace waymark::test {

// A screen of a terminal, generously.
inline constexpr std::size_t kMaxLines = 30, kMaxBytes = 3500;

/// Returns the letters of a text, in lower case.
inline std::string letters_of(std::string_view text) {
  std::string letters;
  for (const char c : text)
    if (std::isalpha(static_cast<unsigned char>(c)))
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters;
}

/// Returns what is wrong with a message about a bad file; empty if nothing is. `content`: of the file, whose
/// words a message may repeat.
inline std::string fault_of_text(const Error& error, std::string_view content = {}) {
  const std::string said = error.what();
  if (error.code() != ErrorCode::input && error.code() != ErrorCode::usage)
    return "an error of another kind: " + said;
  if (error.problem().empty()) return "no problem is named: " + said;
  if (said.size() > kMaxBytes || std::ranges::count(said, '\n') > std::ptrdiff_t{kMaxLines})
    return "more than a screen: " + said;
  if (said != printable(said, said.size())) return "control characters: " + printable(said, kMaxBytes);
  for (const char* internal :
       {"json.exception", "std::", "basic_string", "vector::", "stoi", "stod", "map::at"})
    // Readers repeat words without their quotes and case.
    if (said.find(internal) != said.npos &&
        letters_of(content).find(letters_of(internal)) == std::string::npos)
      return std::string("a message of a library: ") + said;
  return {};
}

}  // namespace waymark::test
