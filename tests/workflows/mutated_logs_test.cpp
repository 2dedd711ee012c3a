// SPDX-License-Identifier: Apache-2.0
// Every reader of logs and tracks, given hundreds of damaged files.
#include "exporters/vector/track_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/robot_log.hpp"
#include "tests/support/mutated_files.hpp"
#include "workflows/evaluation/evaluate.hpp"
#include "workflows/registries.hpp"

namespace waymark::test {
using namespace workflows;
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog = R"({"kind":"header","version":1,"frame":"map","start":{"x":1,"y":2,"yaw":0.5}}
{"kind":"truth","t":0,"x":1,"y":2,"yaw":0.5}
{"kind":"odometry","t":0,"v":1,"omega":0.1}
{"kind":"sightings","t":0.5,"mount":{"x":0.3,"y":0},"items":[{"type":"rock","range":4,"bearing":-0.2,"landmark":"rk-1","features":{"radius":{"value":0.4,"sd":0.05}}},{"bearing":1}]}
{"kind":"laser","t":0.6,"first_angle":-1.57,"angle_step":0.1,"ranges":[1,null,3]}
{"kind":"depth","t":0.65,"columns":2,"rows":1,"focal":9,"depths":[1,2]}
{"kind":"gnss","t":0.7,"x":1,"y":2,"sd":3}
{"kind":"car","t":0.8,"v":1,"steering":0.1}
{"kind":"step","t":0.9,"dx":1,"dy":0,"dyaw":0.1}
)";

TEST_F(MutatedFiles, OfRobotLogs) {
  check("log.jsonl", kLog, Content::text, 250,
        [](const std::string& path) { importers::import_log(path, all_types(), {.format = "waymark"}); });
}

TEST_F(MutatedFiles, OfCsvLogs) {
  check("log.csv",
        "t,v,omega,bearing,range,landmark,truth_x,truth_y,gnss_x,gnss_y\n0,1,0.1,,,,1,2,,\n0.5,1,0.1,-0.2,4,"
        "rk-1,,,1,2\n"
        "0.5,,,0.3,5,,,,,\n1,1,0.2,,,,2,3,,\n",
        Content::text, 250, [](const std::string& path) { importers::import_log(path, all_types(), {}); });
}

TEST_F(MutatedFiles, OfPoseGraphs) {
  const auto read = [](const char* format) {
    return
        [format](const std::string& path) { importers::import_log(path, all_types(), {.format = format}); };
  };
  check("isam.txt",
        "ODOMETRY 0 1 1 0 0.1 10 0 0 20 0 40\nODOMETRY 1 2 1 0 0.1 10 0 0 20 0 40\n"
        "LANDMARK 0 3 2 1 5 0 4\nLANDMARK 2 3 0.1 1 5 0 4\n",
        Content::text, 100, read("isam"));
  check("a.g2o",
        "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.1\nVERTEX_XY 3 2 1\nFIX 0\n"
        "EDGE_SE2 0 1 1 0 0.1 100 0 0 400 0 1600\nEDGE_SE2_XY 0 3 2 1 25 0 16\n",
        Content::text, 100, read("g2o"));
  check("a.graph",
        "VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0.1\nEDGE2 0 1 1 0 0.1 100 0 400 1600 0 0\n"
        "LANDMARK 0 3 2 1 25 0 16\n",
        Content::text, 100, read("toro"));
}

TEST_F(MutatedFiles, OfMrclam) {
  const auto read = [](const std::string& path) {
    importers::import_log(fs::path(path).parent_path(), all_types(), {.format = "mrclam", .robot = 1});
  };
  const std::string codes = "# Subject Barcode\n1 5\n6 72\n7 27\n";
  const std::string seen = "# Time Subject range bearing\n10.5 72 2.5 0.1\n10.6 27 3.5 -0.1\n";
  write("Robot1_Odometry.dat", "10 0.1 0\n10.2 0.1 0.1\n10.7 0.1 0\n");
  write("Robot1_Measurement.dat", seen);
  write("Robot1_Groundtruth.dat", "10 1 2 0.5\n11 1 2 0.5\n");
  check("Barcodes.dat", codes, Content::text, 100, read);
  check("Robot1_Measurement.dat", seen, Content::text, 100, read);
  check("Robot1_Odometry.dat", "10 0.1 0\n10.2 0.1 0.1\n10.7 0.1 0\n", Content::text, 100, read);
}

TEST_F(MutatedFiles, OfLaserLogs) {
  std::string scan = "100";
  for (int i = 0; i < 361; ++i) scan += " " + std::to_string(8 + i % 3);
  write("DRS.txt", "90 0.5 0.01\n110 0.5 0.02\n");
  write("GPS.txt", "95 -33.1 151.2\n105 -33.2 151.3\n");
  check("LASER.txt", scan + "\n" + scan + "\n", Content::text, 100, [](const std::string& path) {
    importers::import_log(fs::path(path).parent_path(), all_types(), {.format = "victoria-park"});
  });
}

TEST_F(MutatedFiles, OfTracks) {
  localization::Track track;
  for (int i = 0; i < 6; ++i)
    track.rows.push_back({.t = 0.5 * i, .at = {{0.5 * i, 1, 0.1}, Eigen::Matrix3d::Identity()}});
  exporters::write_track_csv(folder_ / "made.csv", track);
  const std::string log = write("truth.jsonl", R"({"kind":"truth","t":0,"x":0,"y":1,"yaw":0.1}
{"kind":"truth","t":3,"x":3,"y":1,"yaw":0.1}
)");
  check("track.csv", read_text(folder_ / "made.csv", "the track"), Content::text, 150,
        [&](const std::string& path) {
          evaluate(TrackEvaluation{.track = path, .truth = log, .max_gap = 10});
        });
}

}  // namespace
}  // namespace waymark::test
