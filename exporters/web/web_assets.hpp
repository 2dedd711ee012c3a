// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::exporters {

/// Style sheet and script of the web map, and the program that fetches its libraries: exporters/web/page,
/// scripts/fetch-maplibre.
extern const std::string_view kSiteStyle, kSiteScript, kFetchMaplibre;

}  // namespace waymark::exporters
