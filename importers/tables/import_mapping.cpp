// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/import_mapping.hpp"

#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

/// Returns "radius=d/2,height=h" for {"radius": "d/2", "height": "h"}.
std::string read_columns(const JsonValue& object) {
  if (!object.is_object()) object.refuse("columns are an object", R"({"radius": "diam_cm/200"})");
  std::string columns;
  for (const std::string& target : object.keys())
    columns += (columns.empty() ? "" : ",") + target + "=" + object[target].text();
  return columns;
}

void read_type(const JsonValue& type, TableImport& table) {
  if (type.is_text()) {
    table.type = type.text();
    return;
  }
  if (!type.is_object())
    type.refuse("the type is a name, or a column with words",
                R"({"column": "kind", "words": {"word": "type"}})");
  type.expect_only({"column", "words"});
  table.type_column = type["column"].text();
  const JsonValue words = type["words"];
  for (const std::string& word : words.keys()) table.type_words[word] = words[word].text();
  if (table.type_words.empty()) words.refuse("no word stands for a landmark type", R"({"word": "type"})");
}

}  // namespace

ImportMapping read_import_mapping(const std::string& file) {
  const JsonValue root = JsonValue::from_file(file);
  if (!root.is_object() || !root.has("waymark_mapping"))
    root.refuse("this is no mapping file", R"(it begins with {"waymark_mapping": 1})");
  root.expect_only({"waymark_mapping", "type", "columns", "columns_of_type", "crs", "map_crs", "layer"});
  if (root["waymark_mapping"].integer() != 1)
    root["waymark_mapping"].refuse("this version of mapping files is not known", "write 1");
  ImportMapping mapping;
  if (root.has("type")) read_type(root["type"], mapping.table);
  if (root.has("columns")) mapping.table.columns = read_columns(root["columns"]);
  if (root.has("columns_of_type"))
    for (const std::string& type : root["columns_of_type"].keys())
      mapping.table.columns_of_type[type] = read_columns(root["columns_of_type"][type]);
  if (root.has("crs")) mapping.table.table_crs = root["crs"].text();
  if (root.has("map_crs")) mapping.table.map_crs = root["map_crs"].text();
  if (root.has("layer")) mapping.layer = root["layer"].text();
  return mapping;
}

}  // namespace waymark::importers
