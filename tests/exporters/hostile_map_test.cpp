// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sqlite3.h>

#include "exporters/formatting.hpp"
#include "exporters/report/inventory_report.hpp"
#include "exporters/report/report_html.hpp"
#include "exporters/vector/export_map.hpp"
#include "exporters/vector/shape_csv.hpp"
#include "exporters/vector/shape_json.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "small_map.hpp"

namespace waymark::test {
using namespace exporters;
namespace {

using test::content_of;
using test::error_of;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMarkup = "'\"><img src=x onerror=alert(1)> onmouseover='alert(1)";

using Rows = std::vector<std::vector<std::string>>;

/// Runs SQL as any other program could; returns its rows, or nothing if SQLite refuses it.
std::optional<Rows> sql(const std::filesystem::path& file, const std::string& script) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  Rows rows;
  const int result = sqlite3_exec(
      database, script.c_str(),
      [](void* into, int count, char** values, char**) {
        auto& row = static_cast<Rows*>(into)->emplace_back();
        for (int i = 0; i < count; ++i) row.emplace_back(values[i] ? values[i] : "");
        return 0;
      },
      &rows, nullptr);
  sqlite3_close(database);
  return result == SQLITE_OK ? std::optional(rows) : std::nullopt;
}

/// Returns a map with rows in every table that the report reads, and without triggers, which would refuse
/// rows.
std::filesystem::path map_with_all_tables(const test::TemporaryFolder& folder) {
  geodb::MapContents contents = test::three_summits("EPSG:4326", -70.05, -32.65, 0.05);
  geodb::ImageRecord image;
  image.name = "a.jpg";
  image.footprint = {{{-70.1, -32.7}, {-70, -32.7}, {-70, -32.6}, {-70.1, -32.6}, {-70.1, -32.7}}};
  image.camera_json = "{}";
  contents.images = {image};
  for (const char* rejected : {"", "too small"}) {
    Observation seen;
    seen.type = contents.landmarks[0].type;
    seen.landmark_uid = *rejected ? "" : contents.landmarks[0].uid;
    seen.rejected = rejected;
    seen.source = image.name;
    seen.pixel = Eigen::Vector2d(5, 5);
    seen.position = contents.landmarks[0].position;
    seen.covariance = contents.landmarks[0].covariance;
    seen.features = contents.landmarks[0].features;
    contents.observations.push_back(seen);
  }
  const auto map = folder / "whole.gpkg";
  geodb::write_map(map, contents);
  const auto triggers = sql(map, "SELECT name FROM sqlite_master WHERE type = 'trigger'");
  for (const auto& trigger : triggers.value()) sql(map, "DROP TRIGGER \"" + trigger[0] + "\"");
  return map;
}

TEST(HostileMap, MarkupInAnyTextColumnStaysText) {
  const test::TemporaryFolder folder;
  const auto whole = map_with_all_tables(folder), map = folder / "hostile.gpkg", page = folder / "page.html";
  int reports = 0, columns = 0;
  const auto names = sql(whole,
                         "SELECT t.name, c.name FROM sqlite_master t, pragma_table_info(t.name) c "
                         "WHERE t.type = 'table' AND t.name NOT LIKE 'sqlite_%' AND t.name NOT LIKE "
                         "'rtree_%' AND c.name NOT IN ('id', 'geom')");
  for (const auto& column : names.value()) {
    std::filesystem::copy_file(whole, map, std::filesystem::copy_options::overwrite_existing);
    const std::string quoted = "'''\"><img src=x onerror=alert(1)> onmouseover=''alert(1)'";
    if (!sql(map, "PRAGMA ignore_check_constraints = ON; UPDATE OR IGNORE \"" + column[0] + "\" SET \"" +
                      column[1] + "\" = " + quoted))
      continue;
    ++columns;
    std::filesystem::remove(page);
    const std::string problem = error_of([&] { write_report(map, page); });
    if (problem.empty()) {
      ++reports;
      const std::string report = content_of(page);
      EXPECT_THAT(report, Not(AnyOf(HasSubstr("<img"), HasSubstr("'\">"), HasSubstr(" onmouseover='"))))
          << column[0] << "." << column[1];
    } else {
      EXPECT_THAT(problem, HasSubstr(map.string())) << column[0] << "." << column[1];
    }
  }
  EXPECT_GT(columns, 100);
  EXPECT_GT(reports, 70);
}

TEST(HostileMap, ColoursAndUnitsOfAMapAreCheckedByKind) {
  const test::TemporaryFolder folder;
  const auto map = map_with_all_tables(folder), page = folder / "page.html";
  sql(map,
      "UPDATE waymark_type SET colour = 'red;}</style><img src=x>'; UPDATE waymark_feature SET unit = "
      "'<img>'");
  write_report(map, page);
  EXPECT_THAT(content_of(page), HasSubstr("--type:#888888"));
  EXPECT_THAT(content_of(page), HasSubstr("&lt;img&gt;"));
  EXPECT_THAT(content_of(page), Not(HasSubstr("<img")));
  std::string found;
  for (const geodb::Finding& finding : geodb::validate_map(map)) found += finding.code + " ";
  EXPECT_THAT(found, HasSubstr("type.colour"));
}

TEST(HostileMap, MarkupInAnInventoryStaysText) {
  InventoryPage page{
      .title = kMarkup, .crs = kMarkup, .stands = {}, .trees = {}, .warnings = {}, .failed = {}};
  page.stands.columns = {{"stand", "", AttributeSpec::Kind::text, ""}};
  page.stands.rows = {{{}, {std::string(kMarkup)}}};
  page.warnings = page.failed = {kMarkup};
  const std::string html = inventory_html(page);
  EXPECT_THAT(html, Not(AnyOf(HasSubstr("<img"), HasSubstr("'\">"))));
  EXPECT_THAT(html, HasSubstr("Content-Security-Policy"));
}

TEST(HostileMap, FormulasInTablesAreText) {
  EXPECT_EQ(csv_text("=1+1"), "'=1+1");
  EXPECT_EQ(csv_text("@SUM(A1,A2)"), "\"'@SUM(A1,A2)\"");
  EXPECT_EQ(csv_text("-2+3"), "'-2+3");
  EXPECT_EQ(csv_text("-2.5e3"), "-2.5e3");
  EXPECT_EQ(csv_text("a=b"), "a=b");
  geodb::ShapeLayer layer;
  layer.columns = {{"stand", "", AttributeSpec::Kind::text, ""}};
  layer.rows = {{{}, {std::string("=HYPERLINK(\"http://x\")")}}};
  EXPECT_EQ(layer_to_csv(layer), "stand\n\"'=HYPERLINK(\"\"http://x\"\")\"\n");
  EXPECT_EQ(layer_to_json(layer), "[\n  {\n    \"stand\": \"=HYPERLINK(\\\"http://x\\\")\"\n  }\n]\n");

  const test::TemporaryFolder folder;
  const auto map = map_with_all_tables(folder);
  sql(map, "UPDATE mountain_top SET uid = '=cmd|x' WHERE uid = 'mt-one'");
  export_map(map, (folder / "out.csv").string());
  EXPECT_THAT(content_of(folder / "out.csv"), HasSubstr("'=cmd|x"));
  export_map(map, (folder / "out.geojson").string());
  EXPECT_THAT(content_of(folder / "out.geojson"), HasSubstr("\"=cmd|x\""));
}

}  // namespace
}  // namespace waymark::test
