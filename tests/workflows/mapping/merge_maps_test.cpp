// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/merge_maps.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>

#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "core/text_file.hpp"
#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

using testing::HasSubstr;

FeatureSpec made_feature(const std::string& name) {
  FeatureSpec feature;
  feature.name = name;
  feature.unit = "m";
  feature.summary = name;
  return feature;
}

class MergeMaps : public ::testing::Test {
 protected:
  static constexpr double kSd = 0.1;

  MergeMaps() {
    for (geodb::MapContents* map : {&a_, &b_}) map->types = all_types();
    a_.run.version = "1";
    a_.run.command_line = "a";
    a_.run.job_json = a_.run.report_json = "{}";
    a_.run.started_utc = "2026-01-02T00:00:00Z";
    b_.run = a_.run;
    b_.run.command_line = "b";
    add(a_, "rock-1", 0, {"one.png", "two.png"});
    add(a_, "rock-2", 10, {"one.png"});
    add(b_, "rock-9", 0.05, {"three.png"});
    add(b_, "rock-8", 20, {"three.png"});
    for (const char* name : {"one.png", "two.png"}) a_.images.push_back(image(name));
    b_.images.push_back(image("three.png"));
  }

  static geodb::ImageRecord image(const std::string& name) {
    geodb::ImageRecord record;
    record.name = name;
    record.camera_json = "{}";
    record.footprint = {{{-5, -5}, {30, -5}, {30, 5}, {-5, 5}}};
    record.gsd = Meters{0.1};
    return record;
  }

  /// Adds a rock of 0.5 m at (x, 0) that these images show.
  static void add(geodb::MapContents& map, const std::string& uid, double x,
                  const std::vector<std::string>& images) {
    const TypeId rock = map.types.id("rock");
    const LandmarkType& type = map.types[rock];
    const std::size_t radius = feature_index(type, "radius");
    Landmark l;
    l.uid = uid;
    l.type = rock;
    l.position.xyz << x, 0, 0;
    l.covariance = Eigen::Matrix3d::Identity() * kSd * kSd;
    l.features.resize(type.features.size());
    l.features[radius] = {0.5, 0, static_cast<int>(images.size())};
    l.attributes.resize(type.attributes.size());
    l.quality = {.seen = static_cast<int>(images.size()),
                 .visible = static_cast<int>(images.size()),
                 .feature_confidences = std::vector<std::optional<double>>(type.features.size())};
    l.confidence = 0.8;
    l.observations = static_cast<int>(images.size());
    map.landmarks.push_back(l);
    for (const std::string& source : images) {
      Observation o;
      o.type = rock;
      o.landmark_uid = uid;
      o.source = source;
      o.pixel = Eigen::Vector2d(x, 1);
      o.position = l.position;
      o.covariance = l.covariance;
      o.confidence = 0.8;
      o.features = l.features;
      map.observations.push_back(o);
    }
  }

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string written(const std::string& name, const geodb::MapContents& contents) const {
    geodb::write_map(file(name), contents);
    return file(name);
  }
  geodb::MapStore merged(const std::vector<std::string>& maps, const std::string& name = "c.gpkg") {
    counts_ = merge_maps({.maps = maps, .result = file(name)});
    EXPECT_TRUE(geodb::validate_map(file(name)).empty()) << geodb::validate_map(file(name)).at(0).text;
    return geodb::MapStore::open(file(name));
  }
  std::string bytes(const std::string& name) const { return read_text(file(name), "the map"); }
  static std::string refusal(const MergeRequest& request) {
    try {
      merge_maps(request);
    } catch (const Error& error) {
      return std::string(error.what()) + " " + error.hint();
    }
    return "not refused";
  }

  LockedFolder folder_{std::filesystem::temp_directory_path()};
  geodb::MapContents a_, b_;
  MergeResult counts_;
};

TEST_F(MergeMaps, DuplicatesBecomeOneAndEvidenceIsKept) {
  const geodb::MapStore c = merged({written("a.gpkg", a_), written("b.gpkg", b_)});
  EXPECT_EQ(c.count("rock"), 3);
  EXPECT_EQ(counts_.fused, 1);
  const Landmark both = c.find("rock-1").value();
  EXPECT_EQ(both.quality.seen, 3);
  EXPECT_EQ(both.observations, 3);
  EXPECT_NEAR(both.position.xyz.x(), 0.025, 1e-9) << "equal covariances: the middle";
  EXPECT_LT(both.covariance(0, 0), kSd * kSd + 1e-3);
  EXPECT_EQ(c.observations_of("rock-1").size(), 3u);
  EXPECT_FALSE(c.find("rock-9"));
  EXPECT_TRUE(c.find("rock-8"));
  EXPECT_EQ(c.observations().size(), a_.observations.size() + b_.observations.size());
  EXPECT_EQ(c.images().size(), 3u);
  EXPECT_EQ(c.runs().size(), 3u);
}

TEST_F(MergeMaps, TheOrderDoesNotMatter) {
  const std::string a = written("a.gpkg", a_), b = written("b.gpkg", b_);
  merged({a, b}, "ab.gpkg");
  merged({b, a}, "ba.gpkg");
  EXPECT_TRUE(bytes("ab.gpkg") == bytes("ba.gpkg"));
  geodb::MapContents third = b_;
  third.landmarks[1].uid = third.observations[1].landmark_uid = "rock-7";
  third.landmarks[1].position.xyz.x() = 40;
  const std::string d = written("d.gpkg", third);
  merged({a, b, d}, "abd.gpkg");
  merged({d, b, a}, "dba.gpkg");
  EXPECT_TRUE(bytes("abd.gpkg") == bytes("dba.gpkg"));
}

TEST_F(MergeMaps, NothingCountsTwice) {
  const std::string a = written("a.gpkg", a_), b = written("b.gpkg", b_);
  const auto landmarks = [](const geodb::MapStore& map) {
    std::string text;
    map.visit("rock", [&](Landmark&& l) {
      text += l.uid + " " + std::to_string(l.position.xyz.x()) + " " + std::to_string(l.covariance(0, 0)) +
              " " + std::to_string(l.quality.seen) + "/" + std::to_string(l.quality.visible) + " " +
              std::to_string(l.confidence) + " " + std::to_string(l.features[0].value) + "\n";
    });
    return text;
  };
  EXPECT_EQ(landmarks(merged({a, a}, "aa.gpkg")), landmarks(geodb::MapStore::open(a)));
  const std::string ab = landmarks(merged({a, b}, "ab.gpkg"));
  EXPECT_EQ(landmarks(merged({file("ab.gpkg"), b}, "abb.gpkg")), ab);
  EXPECT_EQ(landmarks(merged({file("ab.gpkg"), a, b}, "abab.gpkg")), ab);
  EXPECT_EQ(merged({a, a}, "aa.gpkg").observations().size(), a_.observations.size());
}

TEST_F(MergeMaps, LandmarksWithoutObservationsAreTheirOwn) {
  for (geodb::MapContents* map : {&a_, &b_}) {
    map->observations.clear();
    map->images.clear();
  }
  const std::string a = written("a.gpkg", a_), b = written("b.gpkg", b_);
  EXPECT_EQ(merged({a, a}, "aa.gpkg").count("rock"), 2);
  EXPECT_TRUE(geodb::MapStore::open(file("aa.gpkg")).observations().empty());
  const geodb::MapStore c = merged({a, b});
  EXPECT_EQ(c.observations_of("rock-1").size(), 2u);
  EXPECT_EQ(c.observations().size(), 2u) << "others need none";
  EXPECT_EQ(merged({file("c.gpkg"), b}, "cb.gpkg").find("rock-1")->quality.seen,
            c.find("rock-1")->quality.seen);
}

TEST_F(MergeMaps, NamesOfOtherThingsGetASuffix) {
  b_.landmarks[1].uid = b_.observations[1].landmark_uid = "rock-2";  // another rock than that of map a
  b_.images[0].name = b_.observations[0].source = b_.observations[1].source = "one.png";
  b_.images[0].camera_json = R"({"f": 2})";
  const geodb::MapStore c = merged({written("a.gpkg", a_), written("b.gpkg", b_)});
  EXPECT_EQ(c.count("rock"), 3);
  ASSERT_TRUE(c.find("rock-2-2"));
  EXPECT_NE(c.find("rock-2")->position.xyz.x(), c.find("rock-2-2")->position.xyz.x());
  EXPECT_EQ(c.observations_of("rock-2-2").size(), 1u);
  EXPECT_EQ(c.images().size(), 3u);
}

TEST_F(MergeMaps, TypesGetTheFeaturesOfBoth) {
  LandmarkType post;
  post.name = "post";
  post.summary = "A post";
  post.features = {made_feature("height")};
  LandmarkType other = post;
  other.features = {made_feature("girth"), made_feature("height")};
  const auto map_of = [](const LandmarkType& type, double x, const std::string& uid) {
    geodb::MapContents map;
    map.types.add(type);
    Landmark l;
    l.uid = uid;
    l.position.xyz << x, 0, 0;
    l.covariance = Eigen::Matrix3d::Identity();
    for (std::size_t f = 0; f < type.features.size(); ++f)
      l.features.push_back({type.features[f].name == "height" ? 2.0 : 0.3, 0, 1});
    l.quality.feature_confidences.resize(type.features.size());
    map.landmarks = {l};
    return map;
  };
  const std::string a = written("a.gpkg", map_of(post, 0, "p-1"));
  const std::string b = written("b.gpkg", map_of(other, 50, "p-2"));
  const geodb::MapStore c = merged({a, b});
  const LandmarkType& both = *c.types().find("post");
  ASSERT_EQ(both.features.size(), 2u);
  const std::size_t height = feature_index(both, "height"), girth = feature_index(both, "girth");
  EXPECT_DOUBLE_EQ(c.find("p-1")->features[height].value, 2);
  EXPECT_FALSE(c.find("p-1")->features[girth].known());
  EXPECT_DOUBLE_EQ(c.find("p-2")->features[girth].value, 0.3);
  other.features[1].unit = "ft";
  const std::string d = written("d.gpkg", map_of(other, 50, "p-2"));
  EXPECT_THAT(refusal({.maps = {a, d}, .result = file("no.gpkg")}), HasSubstr("feature height"));
  EXPECT_FALSE(std::filesystem::exists(file("no.gpkg")));
}

TEST_F(MergeMaps, LayersAreJoined) {
  const auto layer = [](double x, const std::string& uid) {
    return geodb::ShapeLayer{.name = "ring",
                             .summary = "Rings",
                             .columns = {{"uid", "", AttributeSpec::Kind::text, "Rock"}},
                             .rows = {{.parts = {{.outer = {{x, 0}, {x + 1, 0}, {x, 1}}}}, .values = {uid}}}};
  };
  a_.layers = {layer(0, "rock-1")};
  b_.layers = {layer(0, "rock-9"), layer(20, "rock-8")};
  b_.layers[0].rows.push_back(b_.layers[1].rows[0]);
  b_.layers.pop_back();
  merged({written("a.gpkg", a_), written("b.gpkg", b_)});
  const geodb::ShapeLayer rings = geodb::read_shape_layer(file("c.gpkg"), "ring");
  ASSERT_EQ(rings.rows.size(), 2u) << "both rings of the fused rock are one";
  std::set<std::string> uids;
  for (const geodb::Shape& row : rings.rows) uids.insert(std::get<std::string>(row.values[0]));
  EXPECT_THAT(uids, testing::ElementsAre("rock-1", "rock-8"));
  b_.layers[0].columns[0].name = "stone";
  merged({file("a.gpkg"), written("b.gpkg", b_)}, "d.gpkg");
  EXPECT_THAT(geodb::shape_layers(file("d.gpkg")), testing::ElementsAre("ring", "ring_2"));
}

TEST_F(MergeMaps, ChangesAreFoundWhereBothMapsLook) {
  // Images of both maps cover x from -5 to 30. Earlier: 0, 10, 25 and 29; later: 0.05, 20, 26.5.
  add(a_, "rock-3", 25, {"one.png"});
  add(a_, "rock-4", 29, {"one.png"});
  add(b_, "rock-5", 26.5, {"three.png"});
  a_.landmarks[3].features[feature_index(a_.types[a_.landmarks[3].type], "radius")].value = 1.5;
  add(b_, "rock-6", 60, {"three.png"});  // beyond the images of the earlier map
  const std::string a = written("a.gpkg", a_), b = written("b.gpkg", b_);
  const auto rows = [&](const std::vector<std::string>& maps, double max_move) {
    counts_ = merge_maps({.maps = maps, .result = file("c.gpkg"), .changes = true, .max_move = max_move});
    EXPECT_TRUE(geodb::validate_map(file("c.gpkg")).empty());
    std::set<std::string> texts;
    for (const geodb::Shape& row : geodb::read_shape_layer(file("c.gpkg"), "change").rows) {
      const auto* uid = std::get_if<std::string>(&row.values[2]);
      EXPECT_TRUE(geodb::MapStore::open(file("c.gpkg")).find(*uid)) << *uid;
      const auto* distance = std::get_if<double>(&row.values[5]);
      texts.insert(std::get<std::string>(row.values[0]) + " " + *uid + " " +
                   std::to_string(row.parts[0].outer[0].x()).substr(0, 4) + " " +
                   (distance ? std::to_string(*distance).substr(0, 4) : "-"));
    }
    return texts;
  };
  EXPECT_THAT(rows({a, b}, 5), testing::ElementsAre("gone rock-2 10.0 -", "gone rock-4 29.0 -",
                                                    "moved rock-5 26.5 1.50", "new rock-8 20.0 -"));
  EXPECT_EQ(counts_.gone, 2);
  EXPECT_EQ(counts_.appeared, 1);
  EXPECT_EQ(counts_.moved, 1);
  EXPECT_EQ(counts_.unchanged, 1);
  EXPECT_EQ(counts_.not_covered, 1);
  EXPECT_EQ(rows({a, b}, 1).count("gone rock-3 25.0 -"), 1U) << "1.5 m is too far";
  EXPECT_THAT(rows({b, a}, 5), testing::ElementsAre("gone rock-8 20.0 -", "moved rock-3 25.0 1.50",
                                                    "new rock-2 10.0 -", "new rock-4 29.0 -"))
      << "back in time";
  b_.images[0].gsd = Meters{0.2};  // too coarse for what images of 0.1 m showed
  EXPECT_EQ(rows({a, written("b.gpkg", b_)}, 5).count("gone rock-2 10.0 -"), 0U);
  EXPECT_THAT(refusal({.maps = {a, b, a}, .result = file("no.gpkg"), .changes = true}),
              HasSubstr("from one map to a second, not of 3 maps"));
  EXPECT_THAT(refusal({.maps = {a, b}, .result = file("no.gpkg"), .changes = true, .max_move = -1}),
              HasSubstr("--max-move"));
}

TEST_F(MergeMaps, WithoutImagesTheHullOfTheLandmarksIsCovered) {
  const auto plot = [](std::vector<std::pair<double, double>> positions) {
    geodb::MapContents map;
    map.types = all_types();
    for (const auto& [x, y] : positions) {
      add(map, "t" + std::to_string(map.landmarks.size()), x, {});
      map.landmarks.back().position.xyz.y() = y;
      map.landmarks.back().quality.seen = map.landmarks.back().quality.visible = 1;
    }
    map.run.job_json = map.run.report_json = "{}";
    return map;
  };
  const std::string a = written("a.gpkg", plot({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 4}, {20, 5}}));
  const std::string b = written("b.gpkg", plot({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {7, 8}}));
  counts_ = merge_maps({.maps = {a, b}, .result = file("c.gpkg"), .changes = true, .max_move = 1});
  EXPECT_EQ(counts_.gone, 1) << "(5, 4); (20, 5) is outside the later hull";
  EXPECT_EQ(counts_.appeared, 1);
  EXPECT_EQ(counts_.unchanged, 4);
  EXPECT_EQ(counts_.not_covered, 1);
  // A rock that moved out of the other map's hull is not gone.
  const std::string d = written("d.gpkg", plot({{0, 0}, {10, 0}, {10, 9}, {0, 10}, {5, 4}, {20, 5}}));
  counts_ = merge_maps({.maps = {a, d}, .result = file("e.gpkg"), .changes = true, .max_move = 3});
  EXPECT_EQ(counts_.moved, 1);
  EXPECT_EQ(counts_.gone, 0);
  EXPECT_EQ(counts_.unchanged, 5);
}

TEST_F(MergeMaps, APostThatMovedStandsWhereItWasSeenLast) {
  const auto posts = [](double x, const std::string& time) {
    geodb::MapContents map;
    map.types = all_types();
    map.run.job_json = map.run.report_json = "{}";
    map.run.started_utc = time;
    for (const char* uid : {"p1", "p2"}) {
      Landmark l;
      l.type = map.types.id("beacon");
      l.uid = uid;
      l.position.xyz << (uid[1] == '1' ? x : 50 + 0.005 * x), 0, 0;
      l.covariance = Eigen::Matrix3d::Identity() * 0.01;
      l.features.resize(map.types[l.type].features.size());
      l.quality.seen = l.quality.visible = 1;
      l.quality.feature_confidences.resize(l.features.size());
      l.attributes.resize(map.types[l.type].attributes.size());
      map.landmarks.push_back(l);
    }
    return map;
  };
  const std::string a = written("a.gpkg", posts(0, "2026-05-01T00:00:00Z"));
  const std::string b = written("b.gpkg", posts(10, "2026-01-01T00:00:00Z"));
  const geodb::MapStore c = merged({a, b});
  EXPECT_EQ(counts_.disagreeing, 1);
  EXPECT_EQ(c.find("p1")->position.xyz.x(), 0) << "the run of a is later";
  EXPECT_EQ(c.find("p1")->covariance(0, 0), 0.01);
  EXPECT_EQ(c.find("p2")->quality.seen, 2) << "fused as before";
  EXPECT_EQ(merged({b, a}, "d.gpkg").find("p1")->position.xyz.x(), 0);
  counts_ = merge_maps({.maps = {a, b}, .result = file("e.gpkg"), .changes = true});
  EXPECT_EQ(geodb::MapStore::open(file("e.gpkg")).find("p1")->position.xyz.x(), 10) << "the user's order";
  EXPECT_TRUE(geodb::validate_map(file("e.gpkg")).empty());
  EXPECT_EQ(counts_.moved, 1);
  EXPECT_EQ(counts_.unchanged, 1);
}

TEST_F(MergeMaps, RefusesWhatCannotBeMerged) {
  const std::string a = written("a.gpkg", a_);
  b_.crs = Crs::from_text("EPSG:32633");
  const std::string b = written("b.gpkg", b_);
  geodb::MapContents zone = b_;
  zone.crs = Crs::from_text("EPSG:32632");
  const std::string other = written("other.gpkg", zone);
  const std::string result = file("c.gpkg");
  EXPECT_THAT(refusal({.maps = {a, b}, .result = result}), HasSubstr("waymark register"));
  EXPECT_THAT(refusal({.maps = {b, other}, .result = result}), HasSubstr("waymark export"));
  EXPECT_THAT(refusal({.maps = {a}, .result = result}), HasSubstr("two maps or more"));
  EXPECT_THAT(refusal({.maps = {a, b}, .result = a}), HasSubstr("would replace"));
  EXPECT_THAT(refusal({.maps = {a, file("none.gpkg")}, .result = result}), HasSubstr("cannot be read"));
  EXPECT_FALSE(std::filesystem::exists(result));
}

}  // namespace
}  // namespace waymark::test
