// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
namespace waymark::exporters {

/// Returns the element of the head that allows a page this one inline script, by its SHA-256, and its own
/// styles and data images; no other script, no form and nothing outside the page.
std::string script_policy(std::string_view script);

/// Returns JSON as it may stand in a script element: `<` is written as \u003c.
std::string script_data(std::string_view json);

}  // namespace waymark::exporters
