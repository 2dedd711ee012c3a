// SPDX-License-Identifier: Apache-2.0
// The change from a search of the whole map to a filter that follows the robot.
#include "localization/filters/locating_filter.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace waymark::test {
using namespace localization;
namespace {

/// Says that it is lost for some sets, then that it tracks.
class Search final : public Localizer {
 public:
  explicit Search(int sets) : sets_(sets) {}
  void predict(const BodyMotion& motion) override { at_ = predict_pose(at_, motion); }
  std::vector<Match> update(const SightingSet&) override { return --sets_, std::vector<Match>(); }
  PoseEstimate estimate() const override { return at_; }
  LocalizationStatus status() const override {
    return sets_ > 0 ? LocalizationStatus::lost : LocalizationStatus::tracking;
  }

 private:
  int sets_;
  PoseEstimate at_{{3, 4, 0.5}, Eigen::Matrix3d::Identity()};
};

TEST(LocatingFilter, TracksOnceFromThePoseFound) {
  std::optional<PoseEstimate> found;
  int made = 0;
  LocatingFilter filter(std::make_unique<Search>(3), [&](const PoseEstimate& at) {
    found = at, ++made;
    return std::make_unique<DeadReckoning>(at);
  });
  for (int i = 0; i < 2; ++i) {
    filter.update({});
    EXPECT_EQ(filter.status(), LocalizationStatus::lost);
  }
  EXPECT_FALSE(found);
  filter.update({});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pose.x, 3);
  EXPECT_EQ(filter.status(), LocalizationStatus::tracking);
  filter.predict({{1, 0, 0}, Eigen::Matrix3d::Zero()});
  filter.update({});
  EXPECT_NEAR((filter.estimate().pose.at() - Eigen::Vector2d(3 + std::cos(0.5), 4 + std::sin(0.5))).norm(), 0,
              1e-12);
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace waymark::test
