// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>
#include <string>
#include <string_view>
namespace waymark::exporters {

/// File of a map library that the page loads from its folder `lib`.
struct WebLibraryFile {
  const char *name, *sha256;  ///< of the pinned version, hex
};

/// Returns the files of MapLibre GL JS 5.24.1 and pmtiles 4.5.0, as scripts/fetch-maplibre fetches them.
std::span<const WebLibraryFile> web_library();

/// Returns the files of the page beside style and tiles, by name: index.html, site.js, site.css,
/// fetch-maplibre. The page loads nothing from elsewhere, and a library only if it has the pinned content.
std::map<std::string, std::string> web_page_files(const std::string& title);

}  // namespace waymark::exporters
