// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
namespace waymark {

/// What kind of thing went wrong; decides the exit code of the program.
enum class ErrorCode {
  usage,        ///< wrong option, job file or argument: exit code 2
  input,        ///< a file that is missing, damaged or not what it should be: exit code 1
  output,       ///< a result that cannot be written: exit code 1
  environment,  ///< missing library data, memory, permissions: exit code 1
};

/// A problem the caller can mend. what() is the whole message, three parts on up to three lines:
/// what went wrong, where, and what to do.
class Error : public std::runtime_error {
 public:
  /// `problem` is one line; `where` (a file, an option, a place in it) and `hint` may be empty.
  Error(ErrorCode code, std::string problem, std::string where = {}, std::string hint = {});

  ErrorCode code() const { return code_; }
  const std::string& problem() const { return problem_; }
  const std::string& where() const { return where_; }
  const std::string& hint() const { return hint_; }

 private:
  ErrorCode code_;
  std::string problem_, where_, hint_;
};

/// Exit code of interface.md for an error: 2 for usage, 1 for all else.
int exit_code(ErrorCode code);

/// Why an algorithm dropped an item; counted by reason in the report.
struct Rejection {
  std::string reason;
};

/// The candidate closest to `word` by edit distance, or empty if none is within a third of its length.
std::string nearest_name(std::string_view word, const auto& candidates);

/// Levenshtein distance; O(a b) time.
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

}  // namespace waymark
