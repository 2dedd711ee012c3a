// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::exporters {

/// Style sheet and script of the viewer: exporters/view/view.css and exporters/view/script/*.js in order.
extern const std::string_view kViewStyle, kViewScript;

}  // namespace waymark::exporters
