// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/map_image_control.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <memory>

#include "tests/pipeline/reconstruction/made_pictures.hpp"
#include "tests/pipeline/reconstruction/made_views.hpp"
#include "tests/support/angles.hpp"

namespace waymark::test {
namespace {

using pipeline::LevelImage;

constexpr MadeGround kFlownGround{.longest = 60, .shortest = 3, .seed = 4};

/// Six views from 300 m, and a map with cells of 2 m of the ground that they show.
struct FlownSite {
  std::vector<pipeline::SurfaceView> truth = {};
  LevelImage map = {};
  pipeline::CoarseHeights ground = {};
  std::vector<std::size_t> images = {4, 3, 2, 1, 0, 7};
};

FlownSite flown_site(const MadeGround& shown = kFlownGround) {
  FlownSite site;
  const Camera camera = made_camera(300, 300, 50);
  for (int i = 0; i < 6; ++i) {
    const PosedCamera view = made_view(camera, {i % 3 * 70.0 - 70, i / 3 * 80.0 - 40, 300}, 4, 40.0 * i);
    site.truth.push_back(made_view(std::to_string(i), view, made_picture(shown, view)));
  }
  site.map.grid = {.west = -250, .north = 250, .cell = 2, .columns = 250, .rows = 250};
  site.map.brightness = Grid<float>(250, 250);
  for (std::int64_t r = 0; r < 250; ++r)
    for (std::int64_t c = 0; c < 250; ++c)
      site.map.brightness(c, r) =
          static_cast<float>(kFlownGround.brightness(site.map.grid.x(double(c)), site.map.grid.y(double(r))));
  site.ground = {.grid = {.west = -160, .north = 160, .cell = 20, .columns = 16, .rows = 16},
                 .heights = Grid<float>(16, 16, 0)};
  return site;
}

std::vector<pipeline::SurfaceView> moved(std::vector<pipeline::SurfaceView> views,
                                         const Eigen::Vector3d& by) {
  for (pipeline::SurfaceView& view : views) view.view.grid_from_camera.transform.translation() += by;
  return views;
}

pipeline::MapImageControl control_of(const FlownSite& site, const std::vector<pipeline::SurfaceView>& views) {
  pipeline::ImageLevels images(views, std::size_t{1} << 28);
  return pipeline::control_of_map_image(site.map, site.ground, views, site.images, images);
}

TEST(MapImageControl, MarksShowThePointsOfTheMap) {
  const FlownSite site = flown_site();
  const auto control = control_of(site, moved(site.truth, {9, -7, 0}));  // wrong by 4.5 and 3.5 cells
  ASSERT_GE(control.points.size(), 60U);
  EXPECT_GE(double(control.agreeing), 0.9 * double(control.matched));
  double squares = 0, count = 0;
  for (const pipeline::ControlPoint& point : control.points)
    for (const pipeline::Mark& mark : point.marks) {
      const auto view = std::ranges::find(site.images, mark.image) - site.images.begin();
      const auto pixel = project(site.truth[static_cast<std::size_t>(view)].view, {point.position});
      ASSERT_TRUE(pixel);
      EXPECT_LT((*pixel - mark.pixel).norm(), 2) << point.name;
      squares += (*pixel - mark.pixel).squaredNorm() / (mark.sd * mark.sd), count += 2;
    }
  EXPECT_LT(std::sqrt(squares / count), 1);  // the stated deviations are not too small
}

TEST(MapImageControl, OtherGroundGivesNoPoints) {
  MadeGround other = kFlownGround;
  other.seed = 40;
  const FlownSite site = flown_site(other);
  EXPECT_TRUE(control_of(site, site.truth).points.empty());
}

TEST(MapImageControl, UnknownPartsOfTheMapGiveNoPoints) {
  FlownSite site = flown_site();
  for (std::int64_t r = 0; r < 250; ++r)
    for (std::int64_t c = 0; c < 125; ++c) site.map.brightness(c, r) = std::nanf("");
  const auto control = control_of(site, site.truth);
  ASSERT_FALSE(control.points.empty());
  for (const pipeline::ControlPoint& point : control.points) EXPECT_GT(point.position.x(), 0) << point.name;
}

TEST(MapImageControl, ThreadsDoNotMatter) {
  const FlownSite site = flown_site();
  const auto views = moved(site.truth, {3, 3, 0});
  const auto many = control_of(site, views);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = control_of(site, views);
  ASSERT_EQ(one.points.size(), many.points.size());
  for (std::size_t i = 0; i < one.points.size(); ++i) {
    EXPECT_EQ(one.points[i].name, many.points[i].name);
    ASSERT_EQ(one.points[i].marks.size(), many.points[i].marks.size());
    for (std::size_t m = 0; m < one.points[i].marks.size(); ++m)
      EXPECT_EQ(one.points[i].marks[m].pixel, many.points[i].marks[m].pixel);
  }
}

}  // namespace
}  // namespace waymark::test
