// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/map_element.hpp"

#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kHead = 4096;

bool is_cityjson(const std::string& path) {
  if (!path.ends_with(".json") && !path.ends_with(".city.json")) return false;
  const std::string head = read_vsi_head(path, kHead);
  return head.find("\"CityJSON\"") != std::string::npos;
}

/// Such maps have the tag at each node, so the first ones show it.
bool has_local_nodes(const std::string& path) {
  if (!path.ends_with(".osm")) return false;
  const std::string head = read_vsi_head(path, 16 * kHead);
  return head.find("\"local_x\"") != std::string::npos || head.find("'local_x'") != std::string::npos;
}

/// Reads a quoted word, in which a backslash keeps the next letter. Returns false if there is none.
bool read_quoted(const std::string& text, std::size_t& at, std::string& word) {
  at = text.find('"', at);
  if (at == std::string::npos) return false;
  word.clear();
  for (++at; at < text.size(); ++at) {
    if (text[at] == '"') return ++at, true;
    if (text[at] == '\\' && at + 1 < text.size()) ++at;
    word += text[at];
  }
  return false;
}

}  // namespace

void read_hstore(const std::string& text, std::map<std::string, std::string>& tags) {
  std::string key, value;
  for (std::size_t at = 0; read_quoted(text, at, key) && read_quoted(text, at, value);)
    if (!value.empty()) tags[key] = value;
}

std::unique_ptr<ElementSource> open_elements(const std::string& path, const std::string& layer, bool local) {
  if (is_cityjson(path)) return open_cityjson_elements(path);
  if (has_local_nodes(path) && (local || !has_geographic_nodes(path))) return open_local_osm_elements(path);
  return open_ogr_elements(path, layer);
}

}  // namespace waymark::importers
