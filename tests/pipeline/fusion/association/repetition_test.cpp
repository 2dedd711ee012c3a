// SPDX-License-Identifier: Apache-2.0
// Wrong geometry shows in how many objects other images show again.
#include "pipeline/fusion/association/repetition.hpp"

#include <gmock/gmock.h>

#include "pipeline/fusion/association/checked_alignment.hpp"
#include "tests/pipeline/fusion/made_landing.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

testbed::Scenario landing_scenario(double pose_sd) {
  testbed::Scenario scenario;
  scenario.ground.width = scenario.ground.height = 0;
  scenario.ground.cell = 1;
  scenario.ground.rocks.k = 0.08;
  scenario.lens.columns = scenario.lens.rows = 500;
  scenario.flights.front().images = 8;
  scenario.pose_errors = {pose_sd, Degrees{0.02}};
  return scenario;
}

/// `stated_sd` is what the poses claim; their errors are `true_sd`.
MadeLanding landing_with_poses(std::int64_t seed, double true_sd, double stated_sd) {
  testbed::Scenario scenario = landing_scenario(true_sd);
  scenario.seed = seed;
  MadeLanding made = made_landing(scenario);
  if (stated_sd == true_sd) return made;
  // The covariance of each observation loses what the poses claimed too much.
  for (ImageView& image : made.images)
    image.view->covariance.diagonal().tail<3>().setConstant(stated_sd * stated_sd);
  for (Observation& o : made.observations) {
    const double excess = true_sd * true_sd - stated_sd * stated_sd;
    o.covariance(0, 0) = std::max(o.covariance(0, 0) - excess, 0.003);
    o.covariance(1, 1) = std::max(o.covariance(1, 1) - excess, 0.003);
    o.covariance(0, 1) = o.covariance(1, 0) = 0;
  }
  return made;
}

Repetition of(const MadeLanding& made) {
  return measure_repetition(made.observations, made.images, made.types, Crs::local());
}

TEST(Repetition, IsHighWhereThePosesAreAsStated) {
  for (const std::int64_t seed : {31, 32}) {
    const Repetition seen = of(landing_with_poses(seed, 0.1, 0.1));
    EXPECT_GT(seen.expected, 200U);
    EXPECT_GT(seen.found(), 0.7);
    EXPECT_LE(seen.found(), 1);
  }
}

TEST(Repetition, IsLowWhereThePosesAreWorseThanStated) {
  for (const std::int64_t seed : {31, 32}) EXPECT_LT(of(landing_with_poses(seed, 3, 0.05)).found(), 0.35);
}

TEST(Repetition, MatchesByChanceDoNotCount) {
  MadeLanding made = landing_with_poses(33, 0.1, 0.1);
  Random random(1, "scatter");
  for (Observation& o : made.observations) {  // objects anywhere
    o.position.xyz.x() += random.uniform(-30, 30);
    o.position.xyz.y() += random.uniform(-30, 30);
  }
  EXPECT_NEAR(of(made).found(), 0, 0.1);
}

TEST(Repetition, OneImageExpectsNothing) {
  MadeLanding made = landing_with_poses(31, 0.1, 0.1);
  made.images.resize(1);
  EXPECT_EQ(of(made).expected, 0U);
  EXPECT_EQ(of(made).found(), 0);
}

TEST(Repetition, DoesNotDependOnTheOrder) {
  MadeLanding made = landing_with_poses(31, 0.3, 0.1);
  const Repetition forward = of(made);
  std::ranges::reverse(made.observations);
  std::ranges::reverse(made.images);
  const Repetition backward = of(made);
  EXPECT_EQ(forward.expected, backward.expected);
  EXPECT_NEAR(forward.raw, backward.raw, 1e-12);
  EXPECT_NEAR(forward.chance, backward.chance, 1e-12);
}

double doubled_fraction(MadeLanding made, const std::vector<Observation>& aligned) {
  made.observations = aligned;
  const MergeScore score = merge_score(made, merge_observations(made.observations, made.types, Crs::local()));
  return static_cast<double>(score.doubled) / score.landmarks;
}

TEST(CheckedAlignment, LeavesSoundPosesAsTheyAre) {
  const MadeLanding made = landing_with_poses(34, 0.15, 0.15);
  const CheckedAlignment checked =
      align_and_check(made.observations, made.images, made.dem, made.types, Crs::local());
  ASSERT_EQ(checked.verdict, CheckedAlignment::Verdict::sound)
      << checked.stated.found() << " of the objects are found again as stated, " << checked.aligned.found()
      << " with " << checked.added_position_sd << " m added";
  const Alignment plain = align_images(made.observations, made.images, made.dem, made.types, Crs::local());
  for (std::size_t i = 0; i < plain.observations.size(); ++i)
    EXPECT_EQ(checked.alignment.observations[i].position.xyz, plain.observations[i].position.xyz);
}

TEST(CheckedAlignment, WidensPosesThatAreWorseThanStated) {
  for (const std::int64_t seed : {35, 36}) {
    const MadeLanding made = landing_with_poses(seed, 3, 0.05);
    const CheckedAlignment checked =
        align_and_check(made.observations, made.images, made.dem, made.types, Crs::local());
    EXPECT_EQ(checked.verdict, CheckedAlignment::Verdict::widened);
    EXPECT_GT(checked.aligned.found(), 0.7);
    EXPECT_GT(checked.aligned.found(), checked.stated.found() + 0.2);
    const Alignment plain = align_images(made.observations, made.images, made.dem, made.types, Crs::local());
    EXPECT_LT(doubled_fraction(made, checked.alignment.observations),
              0.2 * doubled_fraction(made, plain.observations));
  }
}

TEST(CheckedAlignment, EstimatesAnUncertaintyThatIsNotStated) {
  MadeLanding made = landing_with_poses(37, 0.4, 0.05);
  for (ImageView& image : made.images) image.view->covariance.setZero();
  const CheckedAlignment checked =
      align_and_check(made.observations, made.images, made.dem, made.types, Crs::local());
  EXPECT_EQ(checked.verdict, CheckedAlignment::Verdict::widened);
  EXPECT_GT(checked.added_position_sd, 0.1);
  EXPECT_LT(checked.added_position_sd, 1.5);
}

TEST(CheckedAlignment, APositionWithoutDeviationIsUnknownBesideAKnownRotation) {
  MadeLanding made = landing_with_poses(37, 0.4, 0.05);
  for (ImageView& image : made.images) image.view->covariance.bottomRightCorner<3, 3>().setZero();
  const CheckedAlignment checked =
      align_and_check(made.observations, made.images, made.dem, made.types, Crs::local());
  EXPECT_EQ(checked.verdict, CheckedAlignment::Verdict::widened);
  EXPECT_TRUE(checked.unstated);
  EXPECT_GT(checked.added_position_sd, 0.1);
  EXPECT_LT(checked.added_position_sd, 1.5);
  EXPECT_EQ(checked.added_rotation_sd, 0);
}

TEST(CheckedAlignment, PosesThatStateTheirDeviationsKeepThem) {
  MadeLanding made = landing_with_poses(34, 0.15, 0.15);
  ASSERT_GT(made.images.size(), 4U);
  for (ImageView& image : made.images)
    image.view->covariance.topLeftCorner<3, 3>().diagonal().setConstant(1e-8);
  made.images[2].view->covariance.setZero();
  AlignmentRules rules;
  rules.added_position_sd = 2;
  rules.added_where_unstated = true;
  const Alignment aligned =
      align_images(made.observations, made.images, made.dem, made.types, Crs::local(), rules);
  // Only the third image may move by more than its stated deviation allows.
  for (std::size_t i = 0; i < made.images.size(); ++i) {
    const Eigen::Vector3d step = aligned.images[i].view->centre().xyz - made.images[i].view->centre().xyz;
    EXPECT_LT(step.norm(), i == 2 ? 8 : 0.8) << i;
  }
  EXPECT_GT(aligned.images[2].view->covariance(3, 3), 0);
}

TEST(CheckedAlignment, NoPoseMakesScatteredObjectsFit) {
  MadeLanding made = landing_with_poses(38, 0.1, 0.1);
  Random random(1, "scatter");
  for (Observation& o : made.observations) {
    o.position.xyz.x() += random.uniform(-30, 30);
    o.position.xyz.y() += random.uniform(-30, 30);
  }
  EXPECT_EQ(align_and_check(made.observations, made.images, made.dem, made.types, Crs::local()).verdict,
            CheckedAlignment::Verdict::wrong);
}

/// What a run sees whose camera file or DEM has the error: the scene itself is sound.
MadeLanding spoilt(MadeLanding made, CommonGeometryError::Kind kind, double amount) {
  const double inverse = kind == CommonGeometryError::Kind::focal_length ? 1 / amount : -amount;
  CorrectedGeometry wrong =
      correct_geometry(made.observations, made.images, made.dem, Crs::local(), kind, inverse);
  made.images = std::move(wrong.images);
  made.observations = std::move(wrong.observations);
  return made;
}

MadeLanding landing_with(CommonGeometryError::Kind kind, double amount, std::int64_t seed) {
  return spoilt(landing_with_poses(seed, 0.15, 0.15), kind, amount);
}

CheckedAlignment checked(const MadeLanding& made) {
  return align_and_check(made.observations, made.images, made.dem, made.types, Crs::local());
}

TEST(CommonGeometryError, AFocalLengthIsNamedWithItsFactor) {
  for (const double factor : {0.87, 1.1}) {
    const CheckedAlignment made = checked(landing_with(CommonGeometryError::Kind::focal_length, factor, 41));
    EXPECT_EQ(made.verdict, CheckedAlignment::Verdict::wrong);
    ASSERT_FALSE(made.causes.empty()) << made.stated.found() << " " << made.aligned.found();
    EXPECT_EQ(made.causes.front().kind, CommonGeometryError::Kind::focal_length);
    EXPECT_NEAR(made.causes.front().amount, factor, 0.03);
  }
}

// Images from near the ground, which is crowded: wide gates find as much with any longer focal length.
TEST(CommonGeometryError, AFocalLengthIsNamedOnCrowdedGround) {
  testbed::Scenario scenario = landing_scenario(0.15);
  scenario.ground.rocks.k = 0.1;
  testbed::Flight& descent = scenario.flights.front();
  descent.from_east = 35, descent.from_north = -20, descent.from_altitude = 230;
  descent.to_east = -20, descent.to_north = 25, descent.to_altitude = 95;
  for (const std::int64_t seed : {51, 52, 53}) {
    scenario.seed = seed;
    const CheckedAlignment made =
        checked(spoilt(made_landing(scenario), CommonGeometryError::Kind::focal_length, 1.1));
    ASSERT_FALSE(made.causes.empty()) << seed << " " << made.stated.found() << " " << made.aligned.found();
    EXPECT_EQ(made.causes.front().kind, CommonGeometryError::Kind::focal_length) << seed;
    EXPECT_NEAR(made.causes.front().amount, 1.1, 0.03) << seed;
  }
}

TEST(CommonGeometryError, AHeightIsNamedWithItsMetres) {
  for (const double metres : {-12.0, 20.0}) {
    const CheckedAlignment made = checked(landing_with(CommonGeometryError::Kind::ground_height, metres, 42));
    EXPECT_EQ(made.verdict, CheckedAlignment::Verdict::wrong);
    ASSERT_FALSE(made.causes.empty()) << made.stated.found() << " " << made.aligned.found();
    EXPECT_EQ(made.causes.front().kind, CommonGeometryError::Kind::ground_height);
    EXPECT_NEAR(made.causes.front().amount, metres, 2.5);
  }
}

TEST(CommonGeometryError, TransposedRotationsAreNamed) {
  const CheckedAlignment made = checked(landing_with(CommonGeometryError::Kind::transposed_rotations, 0, 43));
  EXPECT_EQ(made.verdict, CheckedAlignment::Verdict::wrong);
  ASSERT_FALSE(made.causes.empty()) << made.stated.found() << " " << made.aligned.found();
  EXPECT_EQ(made.causes.front().kind, CommonGeometryError::Kind::transposed_rotations);
}

TEST(CommonGeometryError, IsNotBlamedForErrorsOfSinglePoses) {
  for (const std::int64_t seed : {35, 36})
    EXPECT_TRUE(checked(landing_with_poses(seed, 3, 0.05)).causes.empty());
}

TEST(CommonGeometryError, CorrectingNothingChangesNothing) {
  const MadeLanding made = landing_with_poses(44, 0.15, 0.15);
  const CorrectedGeometry same = correct_geometry(made.observations, made.images, made.dem, Crs::local(),
                                                  CommonGeometryError::Kind::ground_height, 0);
  ASSERT_EQ(same.observations.size(), made.observations.size());
  double largest = 0;
  for (std::size_t i = 0; i < same.observations.size(); ++i)
    largest =
        std::max(largest, (same.observations[i].position.xyz - made.observations[i].position.xyz).norm());
  EXPECT_LT(largest, 1e-3);
}

}  // namespace
}  // namespace waymark::test
