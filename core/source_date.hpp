// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include "core/error.hpp"
namespace waymark::inline core {

/// Returns the time that the environment variable SOURCE_DATE_EPOCH fixes, in seconds since 1970 UTC
/// (reproducible-builds.org); `std::nullopt` if it is not set. With it, two runs write the same bytes: all
/// times are this one, all durations 0. Throws Error{usage} if it is not a whole number from 0 on.
inline std::optional<std::chrono::sys_seconds> source_date() {
  const char* text = std::getenv("SOURCE_DATE_EPOCH");
  if (!text || !*text) return std::nullopt;
  const std::string given = text;
  long long seconds = -1;
  const auto [rest, problem] = std::from_chars(given.data(), given.data() + given.size(), seconds);
  if (problem != std::errc() || rest != given.data() + given.size() || seconds < 0 || seconds > 253402300799)
    throw Error(ErrorCode::usage, "SOURCE_DATE_EPOCH is '" + given + "', no number of seconds since 1970",
                "environment", "e.g. SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)");
  return std::chrono::sys_seconds(std::chrono::seconds(seconds));
}

}  // namespace waymark::inline core
