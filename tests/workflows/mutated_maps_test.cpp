// SPDX-License-Identifier: Apache-2.0
// The readers of maps, given hundreds of damaged files.
#include "geodb/validate_map.hpp"
#include "tests/support/mutated_files.hpp"
#include "tests/support/whole_map.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

std::string map_bytes(const fs::path& folder) {
  geodb::write_map(folder / "made.gpkg", map_with_everything(20, 5), {.empty_tables = {"rock"}});
  return read_text(folder / "made.gpkg", "the map");
}

TEST_F(MutatedFiles, OfMaps) {
  check("map.gpkg", map_bytes(folder_), Content::binary, 150, read_whole_map);
}

TEST_F(MutatedFiles, OfMapsThatAreChecked) {
  check("map.gpkg", map_bytes(folder_), Content::binary, 100, [](const std::string& path) {
    if (!geodb::validate_map(path).empty()) throw Error(ErrorCode::input, "the map has errors", path);
  });
}

}  // namespace
}  // namespace waymark::test
