// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// The program on tables written here.
class Import : public testing::Test {
 protected:
  Outcome import(const std::string& text, std::vector<std::string> words, const std::string& name = "t.csv") {
    write_text(folder_.path() / name, text);
    words.insert(words.begin(), {"import", folder_ / name, "-o", map_});
    return waymark(words);
  }
  json landmarks() { return json::parse(waymark({"query", map_, "--format", "json"}).out); }
  /// Values of one column, ascending.
  std::vector<double> values(const std::string& column) {
    std::vector<double> all;
    for (const json& one : landmarks()) all.push_back(one[column]);
    std::ranges::sort(all);
    return all;
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg";
};

TEST_F(Import, CatalogueOfTheMoonByTheNamesOfItsColumns) {
  const Outcome said = import("Lon,Lat,Diam_km\n-177.9,-48.6,76.8\n-124.5,-66.9,37.9\n",
                              {"--type", "crater", "--map-crs", "IAU_2015:30100"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("radius = Diam_km*1000/2, x = Lon, y = Lat"));
  EXPECT_THAT(values("radius"), testing::ElementsAre(18950, 38400));
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
}

TEST_F(Import, ColumnsThatAreNotUsedAreNamed) {
  const std::string text = "x,y,radius,height,quarry,\"Photo no\"\n1,2,0.5,0.6,north,7\n";
  const Outcome said = import(text, {"--type", "rock", "--map-crs", "local"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("not used: quarry, Photo no\n"));
  const Outcome made = import(
      text, {"--type", "rock", "--map-crs", "local", "--columns", "uid=quarry,height=", "--format", "json"});
  EXPECT_EQ(json::parse(made.out)["unused_columns"], json({"height", "Photo no"}));
  EXPECT_THAT(import("x,y,radius,height\n1,2,0.5,0.6\n", {"--type", "rock", "--map-crs", "local"}).err,
              testing::Not(HasSubstr("not used")));
}

TEST_F(Import, ColumnsThatAreNotUsedFillNoScreen) {
  std::string header = "x,y,radius," + std::string(1'000'000, 'c'), row = "1,2,0.5,7";
  for (int i = 0; i < 5000; ++i) header += ",n" + std::to_string(i), row += ",1";
  const Outcome said = import(header + "\n" + row + "\n", {"--type", "rock", "--map-crs", "local"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("n0, n1"));
  EXPECT_THAT(said.err, HasSubstr("n18 and 4981 more\n"));
  EXPECT_LT(said.err.size(), 800u);
}

TEST_F(Import, ARecursiveViewIsRefused) {
  ASSERT_EQ(import("x,y,radius\n1,1,3\n", {"--type", "rock", "--map-crs", "local"}).code, 0);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(map_.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database,
                         "CREATE VIEW endless AS WITH c(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM c) "
                         "SELECT r.* FROM rock r, c",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  const Outcome said =
      waymark({"import", map_, "--from", "ogr", "--type", "rock", "-o", folder_ / "again.gpkg"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, HasSubstr("the file has a recursive view, 'endless'"));
  EXPECT_THAT(said.err, HasSubstr(map_));
}

TEST_F(Import, ExpressionsQuotedNamesAndDeviations) {
  const Outcome said = import(
      "id;\"Ost (m)\";nord;dbh cm;h\nA;100,5;200;30;20\nB;101;201;40;\n",
      {"--type", "tree", "--map-crs", "local", "--columns",
       "uid=id,x=\"Ost (m)\",y=nord,diameter=\"dbh cm\"/100,height=max(h, 2)^1,position_sd=sqrt(0.09)"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(values("x"), testing::ElementsAre(100.5, 101));  // a comma is a point where semicolons separate
  EXPECT_THAT(values("diameter"), testing::ElementsAre(testing::DoubleEq(0.3), testing::DoubleEq(0.4)));
  const json all = landmarks();
  EXPECT_NEAR(all[0]["var_x"], 0.09, 1e-12);
  for (const json& one : all) EXPECT_EQ(one["height"].is_null(), one["uid"] == "B");  // not known, not 0
}

TEST_F(Import, UnknownDeviationsAreNullAndNotZero) {
  ASSERT_EQ(import("x,y,radius\n1,1,3\n2,9,3\n", {"--type", "rock", "--map-crs", "local"}).code, 0);
  for (const json& one : landmarks())
    for (const char* column : {"var_x", "var_y", "cov_xy", "var_z"})
      EXPECT_TRUE(one[column].is_null()) << column;
  EXPECT_EQ(waymark({"validate", map_}).code, 0);

  const Outcome given =
      import("x,y,radius,x_sd,y_sd\n1,1,3,0.2,0.1\n2,9,3,,\n", {"--type", "rock", "--map-crs", "local"});
  ASSERT_EQ(given.code, 0) << given.err;
  int known = 0;
  for (const json& one : landmarks()) {
    known += !one["var_x"].is_null();
    EXPECT_EQ(one["var_x"].is_null(), one["cov_xy"].is_null());
  }
  EXPECT_EQ(known, 1);
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
}

TEST_F(Import, ImplausibleRowsAreRejectedCountedAndKeptAsEvidence) {
  const Outcome said = import("x,y,radius\n1,1,3\n2,2,0.1\n3,,3\n4,4,-1\n5,5,1e9\n",
                              {"--type", "crater", "--map-crs", "local"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err,
              AllOf(HasSubstr("5 rows, 1 landmarks, 4 rejected"), HasSubstr("2 crater radius below 0.5 m"),
                    HasSubstr("1 crater radius above 2e+06 m"), HasSubstr("1 no position"),
                    HasSubstr("t.csv, line 3: crater radius below 0.5 m")));
  EXPECT_EQ(
      bash("sqlite3 " + map_ + " \"SELECT count(*) FROM observation WHERE rejected LIKE 'crater radius%'\"")
          .out,
      "3\n");
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
}

TEST_F(Import, WrongUnitOfAllRowsIsAnErrorThatSaysSo) {
  const Outcome said = import("x,y,radius\n1,1,0.2\n2,2,0.1\n", {"--type", "crater", "--map-crs", "local"});
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, AllOf(HasSubstr("none of the 2 rows is plausible"), HasSubstr("lengths are metres")));
}

TEST_F(Import, BadCellsNameTheirLine) {
  const std::string table = "# a comment\nx,y,radius\n1,1,2\n\n2,2,many\n3,3\n4,4,5\n";
  const std::vector<std::string> words{"--type", "crater", "--map-crs", "local"};
  const Outcome said = import(table, words);
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err,
              AllOf(HasSubstr("'many' is no number, in column 'radius'"), HasSubstr("t.csv, line 5")));
  auto skipping = words;
  skipping.emplace_back("--skip-bad-rows");
  const Outcome skipped = import(table, skipping);
  EXPECT_EQ(skipped.code, 0) << skipped.err;
  EXPECT_THAT(skipped.err, HasSubstr("4 rows, 2 landmarks, 2 rejected"));
  EXPECT_THAT(import("x,y\n1,2\n1,2,3\n", words).err,
              AllOf(HasSubstr("the row has 3 values, the table has 2 columns"), HasSubstr("line 3")));
  EXPECT_THAT(import("x,y\n1,\"2\n", words).err, HasSubstr("a quote is opened and never closed"));
}

TEST_F(Import, ColumnsThatAreNotThereAndTargetsThatAreNone) {
  const std::string table = "lon,lat,diam\n1,2,3\n";
  const std::vector<std::string> to{"--type", "crater", "--map-crs", "EPSG:4326", "--columns"};
  const auto with = [&](const std::string& columns) {
    auto words = to;
    words.push_back(columns);
    return import(table, words);
  };
  EXPECT_THAT(with("radius=diem/2").err,
              AllOf(HasSubstr("no column 'diem'"), HasSubstr("did you mean 'diam'")));
  EXPECT_THAT(with("radios=diam/2").err,
              AllOf(HasSubstr("has no 'radios'"), HasSubstr("did you mean 'radius'")));
  EXPECT_THAT(with("radius=diam//2").err, AllOf(HasSubstr("'/' is not expected here"), HasSubstr("      ^")));
  EXPECT_THAT(with("radius=(diam/2").err, HasSubstr("a parenthesis is not closed"));
  EXPECT_THAT(with("radius").err, HasSubstr("'radius' has no target"));
  EXPECT_THAT(with("radius=diam,radius=diam").err, HasSubstr("gives 'radius' twice"));
  for (const char* bad : {"radius=diem/2", "radius=diam//2", "radius"}) EXPECT_EQ(with(bad).code, 2);
}

TEST_F(Import, WhereAndWhatMustBeKnown) {
  EXPECT_THAT(import("x,y\n1,2\n", {"--type", "rock"}).err,
              AllOf(HasSubstr("does not name its CRS"), HasSubstr("--map-crs")));
  EXPECT_THAT(import("x,y\n1,2\n", {"--map-crs", "local"}).err,
              AllOf(HasSubstr("does not name the type of its rows"), HasSubstr("--type")));
  EXPECT_THAT(import("a,b\n1,2\n", {"--type", "rock", "--map-crs", "local"}).err,
              AllOf(HasSubstr("no column of the table is recognised as x"), HasSubstr("the table has a, b")));
  EXPECT_THAT(import("x,y\n1,2\n", {"--type", "rok", "--map-crs", "local"}).err,
              HasSubstr("did you mean 'rock'"));
}

TEST_F(Import, DegreesAreProjectedIntoTheMap) {
  const Outcome said = import("lon,lat,height\n9,46.9,12\n", {"--type", "tree", "--map-crs", "EPSG:32632"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, HasSubstr("longitudes and latitudes are assumed to be in EPSG:4326"));
  EXPECT_NEAR(values("x")[0], 500000, 1e-6);  // the central meridian of zone 32
  EXPECT_THAT(import("lon,lat\n9,95\n", {"--type", "tree", "--map-crs", "EPSG:4326"}).err,
              HasSubstr("latitude beyond 90 degrees"));
}

TEST_F(Import, TableWithoutHeaderAndColumnTypes) {
  EXPECT_EQ(import("10 20 4\n30 40 6\n",
                   {"--type", "crater", "--map-crs", "local", "--columns", "x=c1,y=-c2,radius=c3/2"}, "t.txt")
                .code,
            0);
  EXPECT_THAT(values("y"), testing::ElementsAre(-40, -20));
  const Outcome said =
      import("type,x,y,radius,height\nrock,1,2,1,1\ncrater,3,4,9,\nufo,5,6,1,1\n", {"--map-crs", "local"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(said.err, AllOf(HasSubstr("2 landmarks"), HasSubstr("1 of another type")));
}

TEST_F(Import, AMappingFileReadsTablesOfOtherPeople) {
  const std::string table = folder_ / "survey.csv", mapping = folder_ / "mapping.json";
  write_text(
      table,
      "Nr,Klasse,Rechts,Hoch,Durchmesser,Hoehe_cm,Tiefe\n"
      "1,Felsblock,10,20,1.0,40,\n2,Krater,30,20,8,,1.5\n3,Baum,50,20,3,900,\n4,Findling,70,20,2,80,\n");
  const std::string good = R"({"waymark_mapping": 1,
    "type": {"column": "Klasse", "words": {"Felsblock": "rock", "Findling": "rock", "Krater": "crater"}},
    "columns": {"uid": "Nr", "x": "Rechts", "y": "Hoch", "position_sd": "0.2"},
    "columns_of_type": {"rock": {"radius": "Durchmesser/2", "radius_sd": "0.05", "height": "Hoehe_cm/100"},
                        "crater": {"radius": "Durchmesser/2", "depth": "Tiefe"}},
    "map_crs": "EPSG:25833"})";
  const auto import = [&](const std::string& text, std::vector<std::string> more = {}) {
    write_text(mapping, text);
    more.insert(more.begin(), {"import", table, "-o", map_, "--mapping", mapping});
    return waymark(more);
  };
  const Outcome made = import(good);
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("4 rows, 3 landmarks, 1 rejected"));
  EXPECT_THAT(made.err, HasSubstr("1 of another type"));
  EXPECT_THAT(
      bash("sqlite3 '" + map_ + "' \"SELECT uid, radius, radius_sd, height, var_x FROM rock ORDER BY uid\"")
          .out,
      HasSubstr("1|0.5|0.05|0.4|0.04\n4|1.0|0.05|0.8|0.04"));
  EXPECT_EQ(bash("sqlite3 '" + map_ + "' \"SELECT uid, radius, radius_sd, depth FROM crater\"").out,
            "2|4.0||1.5\n");

  const Outcome only = import(good, {"--type", "crater"});
  EXPECT_THAT(only.err, HasSubstr("1 landmarks")) << "options win";
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    const Outcome said = import(text);
    EXPECT_NE(said.code, 0);
    return said.err;
  };
  EXPECT_THAT(refusal("\"rock\", \"Krater\"", "\"rokc\", \"Krater\""), HasSubstr("rock"));
  EXPECT_THAT(refusal("\"Klasse\"", "\"Klase\""), HasSubstr("Klasse"));
  EXPECT_THAT(refusal("\"columns\"", "\"colums\""), HasSubstr("columns"));
  EXPECT_THAT(refusal("\"Tiefe\"", "7"), HasSubstr("/columns_of_type/crater/depth"));
  EXPECT_THAT(refusal("\"waymark_mapping\": 1", "\"waymark_mapping\": 2"), HasSubstr("not known"));
  EXPECT_THAT(import("[]").err, HasSubstr("no mapping file"));
}

TEST_F(Import, ForeignGeoPackageWithPolygons) {
  const std::string crowns = folder_ / "crowns.gpkg";
  write_text(folder_.path() / "crowns.csv",
             "name,hoehe,WKT\nfir,21,\"POLYGON((0 0,4 0,4 4,0 4,0 0))\"\npine,18,POINT(10 20)\n");
  ASSERT_EQ(bash("ogr2ogr " + crowns + " " + (folder_ / "crowns.csv") +
                 " -nln crowns -a_srs EPSG:25832 -oo GEOM_POSSIBLE_NAMES=WKT -oo AUTODETECT_TYPE=YES 2>&1")
                .code,
            0);
  const Outcome said = waymark({"import", crowns, "-o", map_, "--type", "tree", "--columns",
                                "height=hoehe,crown_diameter=2*sqrt(geom_area/pi)"});
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(values("height"), testing::ElementsAre(18, 21));
  EXPECT_THAT(values("x"), testing::ElementsAre(2, 10));
  EXPECT_THAT(waymark({"import", crowns, "-o", map_, "--type", "tree", "--layer", "crown"}).err,
              AllOf(HasSubstr("no layer 'crown'"), HasSubstr("did you mean 'crowns'")));
}

TEST_F(Import, MapThatWasExportedComesBackAsItWas) {
  ASSERT_EQ(import("x,y,radius,radius_sd,x_sd,y_sd,confidence\n1,2,3,0.5,0.25,0.5,0.75\n",
                   {"--type", "rock", "--map-crs", "EPSG:32632"})
                .code,
            0);
  const std::string before = waymark({"query", map_, "--format", "csv"}).out, csv = folder_ / "out.csv",
                    again = folder_ / "again.gpkg";
  ASSERT_EQ(waymark({"export", map_, csv}).code, 0);
  ASSERT_EQ(waymark({"import", csv, "-o", again, "--type", "rock", "--map-crs", "EPSG:32632"}).code, 0);
  EXPECT_EQ(waymark({"query", again, "--format", "csv"}).out, before);
}

TEST_F(Import, SameUidTwiceAndForeignBodies) {
  EXPECT_THAT(import("uid,x,y\na,1,1\na,2,2\n", {"--type", "rock", "--map-crs", "local"}).err,
              HasSubstr("two rows have the uid 'a'"));
  EXPECT_THAT(
      import("x,y\n1,1\n", {"--type", "rock", "--crs", "EPSG:4326", "--map-crs", "IAU_2015:30100"}).err,
      HasSubstr("the table is in EPSG:4326, which cannot be transformed to IAU_2015:30100"));
}

TEST_F(Import, FilesThatAreNoTables) {
  const std::vector<std::string> words{"--type", "rock", "--map-crs", "local"};
  EXPECT_THAT(import("", words).err, HasSubstr("the table is empty"));
  EXPECT_THAT(import(std::string("\0\1", 2), words).err, HasSubstr("holds zero bytes"));
  EXPECT_THAT(import("\xFF\xFEx", words).err, HasSubstr("UTF-16"));
  EXPECT_THAT(waymark({"import", folder_ / "no.csv", "-o", map_, "--type", "rock"}).err,
              HasSubstr("no such file"));
  EXPECT_THAT(import("plain", words, "t.doc").err, HasSubstr("no vector layer that GDAL reads"));
}

TEST_F(Import, HeaderAloneGivesAnEmptyMap) {
  const Outcome said = import("x,y,radius\n", {"--type", "crater", "--map-crs", "local"});
  EXPECT_EQ(said.code, 0) << said.err;
  EXPECT_EQ(waymark({"validate", map_}).code, 0);
}

TEST_F(Import, OrderOfRowsDoesNotMatter) {
  const std::vector<std::string> words{"--type", "crater", "--map-crs", "local"};
  ASSERT_EQ(import("x,y,radius\n1,1,3\n1,1,4\n2,2,3\n", words).code, 0);
  const std::string once = waymark({"query", map_, "--format", "csv"}).out;
  ASSERT_EQ(import("x,y,radius\n2,2,3\n1,1,4\n1,1,3\n", words).code, 0);
  EXPECT_EQ(waymark({"query", map_, "--format", "csv"}).out, once);
}

TEST_F(Import, GmlOfAnotherBodyKeepsItsAxes) {
  ASSERT_EQ(import("lon,lat,diam_km\n10.5,-20.25,5.5\n179.9,-21,1.5\n",
                   {"--type", "crater", "--map-crs", "IAU_2015:30100"})
                .code,
            0);
  const std::string gml = folder_ / "craters.gml", back = folder_ / "back.gpkg";
  ASSERT_EQ(waymark({"export", map_, gml}).code, 0);
  EXPECT_THAT(text_of(gml), HasSubstr("<gml:pos>-20.25 10.5"));  // the urn's order: latitude, longitude
  const Outcome read = waymark({"import", gml, "--type", "crater", "-o", back});
  ASSERT_EQ(read.code, 0) << read.err;
  EXPECT_EQ(waymark({"query", back, "--format", "csv"}).out, waymark({"query", map_, "--format", "csv"}).out);
}

}  // namespace
}  // namespace waymark::test
