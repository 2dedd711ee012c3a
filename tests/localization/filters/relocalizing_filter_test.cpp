// SPDX-License-Identifier: Apache-2.0
// Recovery of a lost filter: which poses of the finder it accepts.
#include "localization/filters/relocalizing_filter.hpp"

#include <gtest/gtest.h>

#include "localization/motion_model.hpp"

namespace waymark::test {
using namespace localization;
namespace {

/// Dead reckoning that rejects all sightings and says that it is lost.
class Lost final : public Localizer {
 public:
  explicit Lost(const PoseEstimate& at) : at_(at) {}
  void predict(const BodyMotion& motion) override { at_ = predict_pose(at_, motion); }
  std::vector<Match> update(const SightingSet& seen) override {
    return std::vector<Match>(seen.sightings.size());
  }
  PoseEstimate estimate() const override { return at_; }
  LocalizationStatus status() const override { return LocalizationStatus::lost; }

 private:
  PoseEstimate at_;
};

PoseEstimate at(double x, double y) {
  return {{x, y, 0}, Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal()};
}

/// A robot that drives 0.1 m ahead between sets. The finder answers with the true pose plus an offset.
class LostDrive {
 public:
  explicit LostDrive(std::function<Eigen::Vector2d(int answer)> offset)
      : filter_(
            at(0, 0), [](const PoseEstimate& from) { return std::make_unique<Lost>(from); },
            [this, offset](const SightingSet&) {
              const Eigen::Vector2d off = offset(++answers_);
              PoseSearchResult found;
              found.accepted = at(x_ + off.x(), off.y());
              return found;
            }) {}
  void drive(int sets) {
    for (int i = 0; i < sets; ++i) {
      filter_.predict(twist_motion(0.1, 0, 0, 1, {.along_per_metre = 1e-4, .across_per_metre = 1e-4}));
      x_ += 0.1;
      SightingSet seen;
      SeenLandmark s;
      s.range = 5, s.range_sd = 0.1, s.bearing = 0.1 * i, s.bearing_sd = 0.01;
      seen.sightings.push_back(s);
      filter_.update(seen);
    }
  }
  double error() const { return (filter_.estimate().pose.at() - Eigen::Vector2d(x_, 0)).norm(); }
  int answers() const { return answers_; }
  int restarts() const { return filter_.restarts(); }

 private:
  double x_ = 0;
  int answers_ = 0;
  RelocalizingFilter filter_;
};

TEST(RelocalizingFilter, AcceptsAPoseWithinReachAtOnce) {
  LostDrive drive([](int) { return Eigen::Vector2d(1.2, 0.5); });
  drive.drive(7);
  EXPECT_EQ(drive.answers(), 1);
  EXPECT_EQ(drive.restarts(), 1);
  EXPECT_NEAR(drive.error(), 1.3, 0.01);
}

TEST(RelocalizingFilter, DoubtsAPoseThatOdometryCannotHaveReached) {
  // The places alike differ from answer to answer.
  LostDrive drive([](int answer) { return Eigen::Vector2d(20 + 5 * answer, 7); });
  drive.drive(60);
  EXPECT_GT(drive.answers(), 5);
  EXPECT_EQ(drive.restarts(), 0);
  EXPECT_LT(drive.error(), 0.01);
}

TEST(RelocalizingFilter, AcceptsThreeAnswersThatAgreeAboutARobotThatWasCarried) {
  LostDrive drive([](int) { return Eigen::Vector2d(25, 7); });
  drive.drive(11);
  EXPECT_EQ(drive.restarts(), 0);
  drive.drive(5);
  EXPECT_EQ(drive.restarts(), 1);
  EXPECT_NEAR(drive.error(), std::hypot(25, 7), 0.01);
}

}  // namespace
}  // namespace waymark::test
