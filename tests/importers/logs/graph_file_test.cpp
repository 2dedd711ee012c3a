// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.hpp"
#include "importers/logs/graph_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
#include "localization/slam/graph_solver.hpp"
#include "tests/localization/made_graph.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace localization;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class GraphFile : public ::testing::Test {
 protected:
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("waymark_graph_" + std::to_string(::getpid()) + ".txt");
  void TearDown() override { std::filesystem::remove(file_); }

  importers::ImportedGraph read(const std::string& text) {
    std::ofstream(file_) << text;
    return importers::import_graph(file_, importers::graph_format(file_));
  }
  std::string refusal(const std::string& text, const std::string& format = {}) {
    return message_of([&] {
      std::ofstream(file_) << text;
      const importers::ImportedGraph g =
          importers::import_graph(file_, format.empty() ? importers::graph_format(file_) : format);
      optimise(g.graph);
    });
  }
};

TEST_F(GraphFile, TheSameGraphInThreeDialectsIsTheSame) {
  const auto isam = read(
      "ODOMETRY 0 1 1 0 0.1 10 0 0 20 0 40\nODOMETRY 1 2 1 0 0.1 10 0 0 20 0 40\n"
      "LANDMARK 0 3 2 1 5 0 4\nLANDMARK 2 3 0.1 1 5 0 4\n");
  const auto g2o = read(
      "# made\nVERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.1\nVERTEX_SE2 2 2 0 0.2\nVERTEX_XY 3 2 1\n"
      "FIX 0\nEDGE_SE2 0 1 1 0 0.1 100 0 0 400 0 1600\n"
      "EDGE_SE2 1 2 1 0 0.1 100 0 0 400 0 1600\n"
      "EDGE_SE2_XY 0 3 2 1 25 0 16\r\nEDGE_SE2_XY 2 3 0.1 1 25 0 16\n");
  const auto toro = read(
      "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0.1\nVERTEX2 2 2 0 0.2\n"
      "EDGE2 0 1 1 0 0.1 100 0 400 1600 0 0\nEDGE2 1 2 1 0 0.1 100 0 400 1600 0 0\n"
      "LANDMARK 0 3 2 1 25 0 16\nLANDMARK 2 3 0.1 1 25 0 16\n");
  EXPECT_EQ(isam.format, "isam");
  EXPECT_EQ(g2o.format, "g2o");
  EXPECT_EQ(toro.format, "toro");
  const GraphSolution a = optimise(isam.graph), b = optimise(g2o.graph), c = optimise(toro.graph);
  EXPECT_GT(a.chi2, 0.01);
  EXPECT_NEAR(a.chi2, b.chi2, 1e-8);
  EXPECT_NEAR(a.chi2, c.chi2, 1e-8);
  EXPECT_LT(distance(a.graph, b.graph), 1e-5);
  EXPECT_EQ(a.graph.landmarks[0].id, 3);
}

TEST_F(GraphFile, EdgesAloneAreDistinguishedByTheirZeros) {
  EXPECT_EQ(read("EDGE2 0 1 1 0 0 50 0 0 50 0 100\n").format, "isam");
  EXPECT_EQ(read("EDGE2 0 1 1 0 0 50 0 50 100 0 0\n").format, "toro");
  std::ofstream(file_) << R"({"kind":"odometry","t":0,"v":1,"omega":0})" << '\n';
  EXPECT_EQ(importers::graph_format(file_), "");
}

TEST_F(GraphFile, IsReadAsALogToo) {
  std::ofstream(file_) << "ODOMETRY 0 1 1 0 0.1 10 0 0 10 0 10\nLANDMARK 1 5 3 4 10 0 10\n";
  TypeRegistry types;
  register_landmark_types(types);
  const RobotLog log = importers::import_log(file_, types);
  ASSERT_EQ(log.events.size(), 2u);
  ASSERT_TRUE(log.graph);
  const auto& seen = std::get<SightingSet>(log.events[1].what).sightings.at(0);
  EXPECT_NEAR(*seen.range, 5, 1e-12);
  EXPECT_NEAR(*seen.bearing, std::atan2(4, 3), 1e-12);
  EXPECT_NEAR(seen.range_sd, 0.1, 1e-12);
  EXPECT_NEAR(seen.bearing_sd, 0.02, 1e-12);
  EXPECT_EQ(seen.identity, landmark_key("5"));
}

TEST_F(GraphFile, WhatIsWrongIsNamedWithItsLine) {
  const std::string good = "ODOMETRY 0 1 1 0 0 10 0 0 10 0 10\n";
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 1 0\n"), AllOf(HasSubstr("line 2"), HasSubstr("cut off")));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 1 0 x 10 0 0 10 0 10\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("'x' of ODOMETRY is no number")));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 nan 0 0 10 0 0 10 0 10\n"), HasSubstr("no number"));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 1.5 1 0 0 10 0 0 10 0 10\n"), HasSubstr("no id"));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 1 1 0 0 10 0 0 10 0 10\n"), HasSubstr("to itself"));
  EXPECT_THAT(refusal(good + "ODOMETRY 1 2 1 0 0 10 0 0 0 0 10\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("not positive definite")));
  EXPECT_THAT(refusal(good + "LANDMARK 7 9 1 0 10 0 10\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("pose 7, which the graph does not have")));
  EXPECT_THAT(refusal(good + "ODOMETRY 5 6 1 0 0 10 0 0 10 0 10\n"),
              AllOf(HasSubstr("not connected"), HasSubstr("pose 5")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 0 0 0\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("twice")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 2 1 0 0 1 0 0 1 0 1\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("pose 2")));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("not positive definite")));
  EXPECT_THAT(refusal("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"), HasSubstr("three-dimensional"));
  EXPECT_THAT(refusal("EDGE3 0 1 0.3 0 0 0 0 0.2 10 0 0 0 0 0 10 0 0 0 0 10 0 0 0 10 0 0 10 0 10\n"),
              HasSubstr("three-dimensional"));
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\n"), HasSubstr("no edges"));
  EXPECT_THAT(
      refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nVERTEX_XY 9 1 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"),
      HasSubstr("landmark 9 of the graph has no sighting"));
}

TEST_F(GraphFile, ABearingAloneDoesNotPlaceALandmark) {
  EXPECT_THAT(refusal("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_XY 9 1 1\n"
                      "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_BEARING_SE2_XY 0 9 0.5 100\n"),
              HasSubstr("not determined"));
}

}  // namespace
}  // namespace waymark::test
