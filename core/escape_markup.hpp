// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
namespace waymark::inline core {

/// Escapes text for HTML or XML, in elements and in attributes with either quote.
std::string escape_markup(std::string_view text);

}  // namespace waymark::inline core
