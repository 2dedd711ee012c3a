// SPDX-License-Identifier: Apache-2.0
#include "core/error.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/printable.hpp"

namespace waymark::inline core {
namespace {

// Bytes, so that a message fits on a screen; hints may list every option of a stage.
constexpr std::size_t kMaxProblem = 600, kMaxHint = 1500;

/// Returns the text with line breaks, which file names may have, as \\n.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) line += c == '\n' ? std::string("\\n") : std::string(1, c);
  return line;
}

std::string whole_message(const std::string& problem, const std::string& where, const std::string& hint) {
  std::string text = printable(problem, kMaxProblem);
  if (!where.empty()) text += "\n  " + printable(on_one_line(where), kMaxProblem);
  if (!hint.empty()) text += "\n  " + printable(hint, kMaxHint);
  return text;
}

}  // namespace

Error::Error(ErrorCode code, std::string problem, std::string where, std::string hint)
    : std::runtime_error(whole_message(problem, where, hint)),
      code_(code),
      problem_(std::move(problem)),
      where_(std::move(where)),
      hint_(std::move(hint)) {}

int exit_code(ErrorCode code) {
  return code == ErrorCode::usage ? 2 : 1;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace waymark::inline core
