// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
namespace waymark::inline core {

/// Category of an error; determines the exit code of the program.
enum class ErrorCode {
  usage,        ///< wrong option, job file or argument: exit code 2
  input,        ///< missing, damaged or unsuitable file: exit code 1
  output,       ///< result cannot be written: exit code 1
  environment,  ///< missing library data, memory, permissions: exit code 1
};

/// Problem that the caller can fix. what() returns problem, location and hint, printable and cut to a screen.
class Error : public std::runtime_error {
 public:
  /// `problem` is one line; `where` (a file, an option, a position in it) and `hint` may be empty.
  Error(ErrorCode code, std::string problem, std::string where = {}, std::string hint = {});

  ErrorCode code() const { return code_; }
  const std::string& problem() const { return problem_; }
  const std::string& where() const { return where_; }
  const std::string& hint() const { return hint_; }

 private:
  ErrorCode code_;
  std::string problem_, where_, hint_;
};

/// Returns the exit code of the program (interface.md): 2 for usage, 1 otherwise.
int exit_code(ErrorCode code);

/// Reason for which an algorithm rejected an item; the report counts items by reason.
struct Rejection {
  std::string reason;
};

/// Returns the candidate closest to `word` by edit distance; empty if none is closer than 2 + length / 3.
std::string nearest_name(std::string_view word, const auto& candidates);

/// Computes the Levenshtein distance in O(a b) time.
std::size_t edit_distance(std::string_view a, std::string_view b);

std::string nearest_name(std::string_view word, const auto& candidates) {
  std::string best;
  std::size_t best_distance = 2 + word.size() / 3;
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace waymark::inline core
