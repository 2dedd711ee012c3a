// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/build_tracks.hpp"

#include <gmock/gmock.h>

namespace waymark::test {
using namespace pipeline;
namespace {

// Feature k of every image is at pixel (10 k, image).
std::vector<ImageFeatures> made_images(std::size_t count) {
  std::vector<ImageFeatures> images(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int k = 0; k < 4; ++k) {
      images[i].features.push_back({.pixel = {10.0 * k, double(i)}, .scale = 2, .angle = 0});
      images[i].descriptors.emplace_back();
    }
  return images;
}

TEST(BuildTracks, JoinsMatchesOverImages) {
  const std::vector<VerifiedPair> pairs{{{0, 1}, {{0, 1}, {3, 3}}}, {{1, 2}, {{1, 2}}}};
  const Tracks tracks = build_tracks(made_images(3), pairs);
  ASSERT_EQ(tracks.points.size(), 2u);
  EXPECT_EQ(tracks.conflicts, 0u);
  ASSERT_EQ(tracks.points[0].marks.size(), 3u);
  EXPECT_EQ(tracks.points[0].marks[2].image, 2u);
  EXPECT_EQ(tracks.points[0].marks[2].pixel, Eigen::Vector2d(20, 2));
}

TEST(BuildTracks, NoTrackHasTwoPlacesInAnImage) {
  // 0:0 - 1:0 - 2:0 and 0:0 - 2:1 contradict; the pair with more matches is believed.
  const std::vector<VerifiedPair> pairs{
      {{0, 1}, {{0, 0}, {1, 1}}}, {{0, 2}, {{0, 1}}}, {{1, 2}, {{0, 0}, {2, 2}}}};
  const Tracks tracks = build_tracks(made_images(3), pairs);
  EXPECT_EQ(tracks.conflicts, 1u);
  for (const TiePoint& point : tracks.points)
    for (std::size_t i = 1; i < point.marks.size(); ++i)
      EXPECT_LT(point.marks[i - 1].image, point.marks[i].image);
  ASSERT_EQ(tracks.points[0].marks.size(), 3u);
  EXPECT_EQ(tracks.points[0].marks[2].pixel, Eigen::Vector2d(0, 2));
}

TEST(BuildTracks, FeaturesAtOnePixelAreOnePlace) {
  std::vector<ImageFeatures> images = made_images(2);
  images[0].features[1].pixel = images[0].features[0].pixel;  // a second angle
  images[1].features[1].pixel = images[1].features[0].pixel;
  const std::vector<VerifiedPair> pairs{{{0, 1}, {{0, 0}, {1, 1}}}};
  EXPECT_EQ(build_tracks(images, pairs).points.size(), 1u);
}

}  // namespace
}  // namespace waymark::test
