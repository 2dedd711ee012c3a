// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/track_picture.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <string>

namespace waymark::test {
namespace {

using namespace exporters;

/// Returns a picture of one straight drive of 112 m whose only track has the given name.
std::string picture_of(const std::string& name) {
  TrackPicture picture;
  picture.title = "drive";
  PictureTrack track;
  track.name = name;
  for (int i = 0; i <= 100; ++i) {
    const localization::Pose2 pose{static_cast<double>(i), 0.5 * i, 0};
    picture.truth.push_back({static_cast<double>(i), pose});
    localization::TrackRow row;
    row.t = i;
    row.at = {pose, Eigen::Matrix3d::Identity()};
    track.track.rows.push_back(row);
  }
  picture.tracks.push_back(track);
  return track_picture(picture);
}

double width_of_legend(const std::string& svg) {
  std::smatch found;
  if (!std::regex_search(svg, found, std::regex("y=\"36\" width=\"([0-9.]+)\""))) return 0;
  return std::stod(found[1]);
}

TEST(TrackPicture, LegendIsAsWideAsItsText) {
  EXPECT_EQ(width_of_legend(picture_of("ekf")), 236);
  const std::string name = "/var/tmp/drives/site_17/pictures_alone_ekf.csv";
  const std::string svg = picture_of(name);
  EXPECT_NE(svg.find(name + ", median 0.00 m"), std::string::npos);
  EXPECT_GT(width_of_legend(svg), 36 + 6 * static_cast<double>(name.size() + 15));
}

TEST(TrackPicture, LegendStaysInThePicture) {
  const std::string svg = picture_of("a_track_with_a_long_name_that_needs_much_space.csv");
  std::smatch found;
  ASSERT_TRUE(std::regex_search(svg, found, std::regex("<rect x=\"([-0-9.]+)\" y=\"36\"")));
  const double left = std::stod(found[1]);
  EXPECT_GE(left, 0);
  EXPECT_LE(left + width_of_legend(svg), 900);
}

}  // namespace
}  // namespace waymark::test
