// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
namespace waymark::inline core {

/// Checks that a JSON text is a file of a kind and version that this program reads: `{"waymark_KIND": 1,
/// ...}`. Throws Error{usage} at `source` if it is not JSON, no such object, or of another version.
void check_file_kind(std::string_view json, const std::string& kind, const std::string& source);

}  // namespace waymark::inline core
