// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::exporters {

/// The style sheet of a report: light, dark and print.
extern const std::string_view kPageStyle;
/// The script of a report: it makes the map and the tables interactive. The page is whole without it.
extern const std::string_view kReportScript;

/// Element of the head that forbids a page scripts, forms and anything outside it.
inline constexpr std::string_view kContentPolicy =
    "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; style-src 'unsafe-inline'; "
    "img-src data:; base-uri 'none'; form-action 'none';\">";

}  // namespace waymark::exporters
