// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include "core/error.hpp"
namespace waymark::inline core {

/// Largest depth of objects and lists in a JSON text. The formats that are read need at most ten; recursive
/// code over deeper values overflows the stack.
inline constexpr std::size_t kMaxJsonDepth = 64;

/// First reason for which a text is not JSON that this program reads.
struct JsonFault {
  std::string problem;               ///< "expected ',' or '}' after a member"
  std::size_t line = 1, column = 1;  ///< both from 1; columns are bytes
};

/// Returns the first fault of a text; `std::nullopt` if it is one JSON value (RFC 8259) in UTF-8 with these
/// bounds: depth up to kMaxJsonDepth, numbers within the range of a double. Repeated keys are no fault. Takes
/// linear time and no recursion.
std::optional<JsonFault> find_json_fault(std::string_view text);

/// Returns `text` unchanged, so that it can stand inside the call of a parser. Throws Error{code}, "not valid
/// JSON: ...", at `origin`:line:column if it has a fault.
std::string_view checked_json(std::string_view text, std::string_view origin,
                              ErrorCode code = ErrorCode::input);

/// Returns `text` unchanged, or an empty text if it has a fault, for readers that go on without it.
std::string_view json_or_empty(std::string_view text);

}  // namespace waymark::inline core
