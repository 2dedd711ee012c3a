// SPDX-License-Identifier: Apache-2.0
// Bar codes of MRCLAM logs that are no codes.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "importers/logs/import_log.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/robot_log.hpp"
#include "tests/support/message_of.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using testing::HasSubstr;

localization::RobotLog read_log(const std::string& codes, const std::string& seen_code) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "mrclam_codes";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("Barcodes.dat", codes);
  write("Robot1_Measurement.dat", "10.5 " + seen_code + " 2.5 0.1\n");
  write("Robot1_Odometry.dat", "10 0.1 0\n10.2 0.1 0.1\n");
  write("Robot1_Groundtruth.dat", "10 1 2 0.5\n11 1 2 0.5\n");
  TypeRegistry types;
  register_landmark_types(types);
  return import_log(folder.string(), types, {.format = "mrclam", .robot = 1});
}

std::ptrdiff_t unknown_codes(const std::string& seen_code) {
  return std::ranges::count_if(read_log("6 72\n7 27\n", seen_code).remarks, [](const std::string& remark) {
    return remark.find("not in Barcodes.dat") != std::string::npos;
  });
}

TEST(MrclamCodes, AreUnknownUnlessListed) {
  EXPECT_EQ(unknown_codes("72"), 0);
  for (const char* code : {"73", "72.5", "nan", "inf", "333333333334"})
    EXPECT_EQ(unknown_codes(code), 1) << code;
}

TEST(MrclamCodes, OfTheListAreWholeNumbers) {
  for (const char* codes : {"6 nan\n", "6.5 72\n", "6 1e300\n"})
    EXPECT_THAT(message_of([&] { read_log(codes, "72"); }), HasSubstr("is no whole number")) << codes;
}

}  // namespace
}  // namespace waymark::test
