// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
namespace waymark::inline core {

/// Returns a text with a-z for A-Z. Other bytes stay, so UTF-8 stays valid.
std::string lower_case(std::string_view text);

}  // namespace waymark::inline core
