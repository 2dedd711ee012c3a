// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
namespace waymark::exporters {

/// Compresses bytes as a gzip file (RFC 1952) without name and time. Throws Error{environment} if memory is
/// short.
std::string gzip(std::string_view bytes);

}  // namespace waymark::exporters
