// SPDX-License-Identifier: Apache-2.0
// Recovery of a lost filter: which poses of the finder it accepts.
#include "localization/filters/relocalizing_filter.hpp"

#include <gtest/gtest.h>

#include <memory>

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

/// Dead reckoning that matches as many of four sightings as `matched` says of its pose.
class Counting final : public Localizer {
 public:
  using Matched = std::function<std::size_t(const Pose2&)>;
  Counting(const PoseEstimate& at, Matched matched) : at_(at), matched_(std::move(matched)) {}
  void predict(const BodyMotion& motion) override { at_ = predict_pose(at_, motion); }
  std::vector<Match> update(const SightingSet& seen) override {
    std::vector<Match> matches(seen.sightings.size());
    for (std::size_t i = 0; i < matches.size(); ++i)
      matches[i].verdict = i < matched_(at_.pose) ? Verdict::matched : Verdict::too_far;
    return matches;
  }
  PoseEstimate estimate() const override { return at_; }
  LocalizationStatus status() const override { return LocalizationStatus::tracking; }

 private:
  PoseEstimate at_;
  Matched matched_;
};

/// A robot that stands at the origin. For thirty sets its filter matches all sightings, then as `matched`
/// says. The finder answers with one pose, precise to a centimetre as the filter's own.
RelocalizingFilter stand(double own_x, double found_x, const Counting::Matched& matched) {
  const auto precise = [](double x) {
    return PoseEstimate{{x, 0, 0}, Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal()};
  };
  const auto sets = std::make_shared<int>(0);
  RelocalizingFilter filter(
      precise(own_x),
      [=](const PoseEstimate& from) {
        return std::make_unique<Counting>(
            from, [=](const Pose2& at) { return *sets <= 30 ? std::size_t{4} : matched(at); });
      },
      [=](const SightingSet&) {
        PoseSearchResult found;
        found.accepted = precise(found_x);
        return found;
      });
  SightingSet seen;
  for (int i = 0; i < 4; ++i) {
    SeenLandmark s;
    s.range = 5, s.range_sd = 0.1, s.bearing = 0.4 * i, s.bearing_sd = 0.01;
    seen.sightings.push_back(s);
  }
  for (; *sets < 60; ++*sets) filter.update(seen);
  return filter;
}

// What is remembered has errors in common, so a pose from it may be wrong by more than it states.
TEST(RelocalizingFilter, KeepsItsPoseWhereOneNearbyExplainsNoMore) {
  const RelocalizingFilter filter = stand(0, 0.3, [](const Pose2&) { return 1; });
  EXPECT_EQ(filter.restarts(), 0);
  EXPECT_NEAR(filter.estimate().pose.x, 0, 1e-9);
}

TEST(RelocalizingFilter, TakesAPoseNearbyThatExplainsMore) {
  const RelocalizingFilter filter =
      stand(0.3, 0, [](const Pose2& at) { return std::abs(at.x) < 0.1 ? 3 : 1; });
  EXPECT_EQ(filter.restarts(), 1);
  EXPECT_NEAR(filter.estimate().pose.x, 0, 1e-9);
}

}  // namespace
}  // namespace waymark::test
