// SPDX-License-Identifier: Apache-2.0
#include "core/options/file_kind.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"

namespace waymark::inline core {

void check_file_kind(std::string_view json, const std::string& kind, const std::string& source) {
  const auto file = nlohmann::json::parse(checked_json(json, source, ErrorCode::usage));
  const std::string key = "waymark_" + kind;
  if (!file.is_object() || !file.contains(key))
    throw Error(
        ErrorCode::usage, fmt::format("this is no {} file", kind), source,
        fmt::format(R"(it begins {{"{}": 1, ...}}; `waymark {}s NAME --format json` prints one)", key, kind));
  if (file[key] != 1)
    throw Error(ErrorCode::usage, fmt::format("the version of the {} file is unknown", kind), source,
                fmt::format(R"(this program reads "{}": 1)", key));
}

}  // namespace waymark::inline core
