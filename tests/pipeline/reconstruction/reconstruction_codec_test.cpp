// SPDX-License-Identifier: Apache-2.0
// Kept results of a reconstruction come back as they were; damaged bytes are refused.
#include "pipeline/reconstruction/reconstruction_codec.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/random.hpp"
#include "tests/support/round_trip.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

/// Random values, among them empty lists and absent members.
class Made {
 public:
  explicit Made(std::uint64_t seed) : random_(seed, "codec") {}

  double number() { return random_.bernoulli(0.1) ? -0.0 : random_.normal(0, 1e3); }
  std::size_t count() { return random_.poisson(2); }
  template <class T>
  std::vector<T> list(const std::function<T()>& make) {
    std::vector<T> all(count());
    for (T& item : all) item = make();
    return all;
  }
  template <class Matrix>
  Matrix matrix() {
    Matrix m;
    for (auto& v : m.reshaped()) v = number();
    return m;
  }
  Camera camera() {
    Camera c;
    c.columns = 640, c.rows = 480;
    c.fx = number(), c.fy = number(), c.cx = number(), c.cy = number(), c.skew = number();
    c.lens = random_.bernoulli(0.5) ? Camera::Lens::fisheye : Camera::Lens::brown;
    for (double& d : c.distortion) d = number();
    return c;
  }
  ImageFeatures features() {
    ImageFeatures f;
    f.features = list<Feature>([&] { return Feature{matrix<Eigen::Vector2d>(), number(), number()}; });
    f.descriptors.resize(f.features.size());
    for (Descriptor& d : f.descriptors)
      for (std::uint8_t& v : d) v = static_cast<std::uint8_t>(random_.uniform(0, 255));
    return f;
  }
  ImageMatches matches() {
    ImageMatches m;
    m.pairs = list<MatchedPair>([&] {
      MatchedPair pair;
      pair.images = {count(), count() + 3};
      pair.geometry.kind = PairKind::planar;
      pair.geometry.inliers = list<Match>([&] {
        return Match{1, std::numeric_limits<std::uint32_t>::max()};
      });
      pair.geometry.poses = list<RelativePose>([&] {
        return RelativePose{matrix<Eigen::Matrix3d>(), matrix<Eigen::Vector3d>()};
      });
      pair.geometry.angles = {number(), number(), number()};
      pair.geometry.homography_inliers = count();
      return pair;
    });
    m.lenses = list<LensGuess>([&] { return LensGuess{camera(), number(), number()}; });
    for (std::size_t i = 0; i < m.lenses.size(); ++i) m.voted.push_back(random_.bernoulli(0.5));
    m.tried = count();
    return m;
  }
  Reconstruction scene() {
    Reconstruction s;
    s.frame = ReconstructionFrame::metric;
    s.sigma0 = number();
    s.lenses = list<AdjustedLens>([&] {
      AdjustedLens lens{camera(), {"f", "k1"}, Eigen::MatrixXd::Zero(2, 2)};
      lens.covariance << 1, number(), 3, 4;
      lens.readout_time = number();
      return lens;
    });
    s.images = list<AdjustedImage>([&] {
      AdjustedImage image{.name = "image/a.png", .lens = count()};
      image.component = count();
      if (random_.bernoulli(0.7)) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation() = matrix<Eigen::Vector3d>();
        image.world_from_camera = pose;
      }
      if (random_.bernoulli(0.7)) image.covariance = matrix<Eigen::Matrix<double, 6, 6>>();
      if (random_.bernoulli(0.7)) image.time = number();
      if (random_.bernoulli(0.7)) image.motion = {matrix<Eigen::Vector3d>(), matrix<Eigen::Vector3d>()};
      return image;
    });
    s.points = list<TiePoint>([&] {
      TiePoint point;
      point.marks = list<Mark>([&] { return Mark{count(), matrix<Eigen::Vector2d>(), number()}; });
      if (random_.bernoulli(0.7)) point.position = matrix<Eigen::Vector3d>();
      if (random_.bernoulli(0.7)) point.covariance = matrix<Eigen::Matrix3d>();
      return point;
    });
    return s;
  }
  SolvedPoses solved() {
    SolvedPoses s;
    s.components = list<SolvedComponent>([&] { return SolvedComponent{scene(), count()}; });
    s.failures = list<std::string>([&] { return std::string(count(), 'x'); });
    return s;
  }
  ChunkHeights chunk() {
    ChunkHeights c;
    c.window = {256, 512, 2, 1};
    c.height = {1.5F, std::numeric_limits<float>::quiet_NaN()};
    c.sd = c.score = c.angle = c.gsd = {0.25F, 2};
    c.views = {2, 0};
    c.reason = {NoHeight::none, NoHeight::jump};
    c.block = {0, 0};
    c.blocks = list<ChosenViews>([&] {
      ChosenViews v;
      v.views = {count(), count()};
      v.pairs = {{0, 1, number()}};
      v.pairs_in_halves = count(), v.gsd = number(), v.angle = number(), v.candidates = 5;
      return v;
    });
    return c;
  }

 private:
  Random random_;
};

TEST(ReconstructionCodec, ValuesComeBack) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Made made(seed);
    expect_round_trip(made.features(), 200);
    expect_round_trip(made.matches(), 200);
    expect_round_trip(made.scene(), 200);
    expect_round_trip(made.solved(), 200);
    expect_round_trip(made.chunk(), 200);
  }
}

TEST(ReconstructionCodec, FeaturesAreEqual) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const ImageFeatures features = Made(seed).features();
    EXPECT_EQ(Codec<ImageFeatures>::decode(Codec<ImageFeatures>::encode(features)), features);
  }
}

// The values of each member, since equal bytes would not show a member that is left out.
TEST(ReconstructionCodec, NoMemberIsLeftOut) {
  Reconstruction scene;
  for (std::uint64_t seed = 1;
       scene.points.empty() || scene.images.empty() || scene.lenses.empty() || !scene.points[0].covariance ||
       scene.points[0].marks.empty() || !scene.images[0].covariance || !scene.images[0].world_from_camera;
       ++seed)
    scene = Made(seed).scene();
  const Reconstruction back = Codec<Reconstruction>::decode(Codec<Reconstruction>::encode(scene));
  EXPECT_EQ(back.frame, scene.frame);
  EXPECT_EQ(back.sigma0, scene.sigma0);
  EXPECT_EQ(back.lenses[0].camera, scene.lenses[0].camera);
  EXPECT_EQ(back.lenses[0].parameters, scene.lenses[0].parameters);
  EXPECT_EQ(back.lenses[0].covariance, scene.lenses[0].covariance);
  const AdjustedImage &image = scene.images[0], &same = back.images[0];
  EXPECT_EQ(same.name, image.name);
  EXPECT_EQ(same.lens, image.lens);
  EXPECT_EQ(same.component, image.component);
  EXPECT_EQ(same.world_from_camera->matrix(), image.world_from_camera->matrix());
  EXPECT_EQ(*same.covariance, *image.covariance);
  const TiePoint &point = scene.points[0], &twin = back.points[0];
  EXPECT_EQ(*twin.position, *point.position);
  EXPECT_EQ(*twin.covariance, *point.covariance);
  EXPECT_EQ(twin.marks[0].image, point.marks[0].image);
  EXPECT_EQ(twin.marks[0].pixel, point.marks[0].pixel);
  EXPECT_EQ(twin.marks[0].sd, point.marks[0].sd);
}

}  // namespace
}  // namespace waymark::test
