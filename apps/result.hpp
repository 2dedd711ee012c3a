// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>
namespace waymark::apps {

/// Kind of a value of a result.
enum class ResultKind { text, flag, integer, number, texts, counts, object, objects };

/// Returns "text", "flag", "integer", ... as the reference page and `waymark help --format json` name a kind.
std::string name_of(ResultKind kind);

/// Key of the JSON object that a command prints with `--format json`.
struct ResultKey {
  std::string name;  ///< with its unit: "shift_m"
  ResultKind kind = ResultKind::text;
  std::string meaning = {};  ///< one line, and when it is null
};

/// JSON text of an object, or of a list of objects.
struct ResultJson {
  std::string text;
};

/// Value of a key. std::monostate and numbers that are not finite are null.
using ResultValue = std::variant<std::monostate, bool, std::int64_t, double, std::string,
                                 std::vector<std::string>, std::map<std::string, std::int64_t>, ResultJson>;

/// Returns the text; null if it is empty.
ResultValue text_or_null(std::string text);

/// Returns the values as the text of a JSON object, for a key of the kind object or objects.
std::string result_object(const std::vector<std::pair<std::string, ResultValue>>& values);

/// Prints the values as one JSON object on standard output, in the order of the declared keys. Throws
/// std::logic_error for a key that is missing or not declared, and for a value of another kind.
void print_result(std::span<const ResultKey> declared,
                  const std::vector<std::pair<std::string, ResultValue>>& values);

}  // namespace waymark::apps
