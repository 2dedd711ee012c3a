// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/web_page.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "core/escape_markup.hpp"
#include "exporters/report/base64.hpp"
#include "exporters/web/web_assets.hpp"

namespace waymark::exporters {
namespace {

constexpr std::array<WebLibraryFile, 3> kLibrary{{
    {"maplibre-gl.js", "a9c9e2aa36d4d5b63b131f27c1272f1a28883eeecc0eddd1e0dbfae4033bc7c9"},
    {"maplibre-gl.css", "ab1e70d59ec40465bae7e7030da2f3ccf28133fd502e62bd598eefbadfd7a732"},
    {"pmtiles.js", "caf981bc46f6327ee7e65d5dc964d89d38a69f60edca2bd4c5c890c21b554c6c"},
}};

std::string integrity(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    unsigned byte = 0;
    std::from_chars(hex.data() + i, hex.data() + i + 2, byte, 16);
    bytes += static_cast<char>(byte);
  }
  return "sha256-" + base64(bytes);
}

std::string index_html(const std::string& title) {
  std::string libraries;
  for (const auto& [name, sha256] : kLibrary)
    libraries +=
        std::string_view(name).ends_with(".css")
            ? fmt::format("<link rel='stylesheet' href='lib/{}' integrity='{}'>\n", name, integrity(sha256))
            : fmt::format("<script src='lib/{}' integrity='{}'></script>\n", name, integrity(sha256));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'self'; worker-src blob:; "
      "img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
      "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
      "<meta name='generator' content='Waymark'>\n<link rel='icon' href='data:,'>\n<title>{0}</title>\n{1}"
      "<link rel='stylesheet' href='site.css'>\n</head>\n<body>\n<h1>{0}</h1>\n<div id='map'></div>\n"
      "<aside id='panel'></aside>\n<output id='position'></output>\n<div id='scale'></div>\n"
      "<noscript><p class='problem'>The map is drawn by a script, which this browser does not run. "
      "`waymark report` makes a page without.</p></noscript>\n<script src='site.js'></script>\n"
      "</body>\n</html>\n",
      escape_markup(title), libraries);
}

}  // namespace

std::span<const WebLibraryFile> web_library() {
  return kLibrary;
}

std::map<std::string, std::string> web_page_files(const std::string& title) {
  return {{"index.html", index_html(title)},
          {"site.css", std::string(kSiteStyle)},
          {"site.js", std::string(kSiteScript)},
          {"fetch-maplibre", std::string(kFetchMaplibre)}};
}

}  // namespace waymark::exporters
