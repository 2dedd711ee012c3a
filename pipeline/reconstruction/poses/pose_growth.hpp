// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "pipeline/reconstruction/matching/match_images.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

struct GrowthSettings {
  double pixels = 4;            ///< largest residual of a mark, pixels
  double of_diagonal = 1.2e-3;  ///< the same as a fraction of the image diagonal; the larger counts
  double min_angle = 0.017;     ///< smallest largest angle between the rays of a point, radians
  std::size_t min_points = 12;  ///< points that a new image must agree with
  double min_fraction = 0.3;    ///< of the points it sees
};

/// Poses that grow image by image from a pair.
class PoseGrowth {
 public:
  /// `start` has lenses, images without poses and tracks without positions.
  PoseGrowth(Reconstruction start, std::vector<LensGuess> guesses, GrowthSettings settings);

  /// Poses two images by their relative pose. Returns whether enough points agree.
  bool seed(const ImagePair& images, const RelativePose& pose);
  /// Poses further images while any can be, and adjusts. The images most of whose points are known and well
  /// spread come first.
  void grow();
  /// Replaces the tracks, triangulates them and adjusts all.
  void finish(std::vector<TiePoint> tracks);

  /// Adjusts what has grown and returns its cost: the sum of ln(1 + r^2 / s^2) over the marks in posed
  /// images, with residuals r up to the limit and deviations s, both in pixels. `tracks` are those it started
  /// with; marks that it lost since count as the limit.
  double settled_cost(std::span<const TiePoint> tracks);

  const Reconstruction& scene() const { return scene_; }
  std::size_t posed() const;
  /// Returns the number of positioned points that an image shows.
  std::size_t known_points(std::size_t image) const;
  /// Returns the prior knowledge of the lenses as observations.
  static std::vector<LensPrior> lens_priors(std::span<const LensGuess> guesses);

 private:
  struct Visible {
    std::size_t point = 0, mark = 0;
  };
  void index_marks();
  bool add(std::size_t image);
  std::optional<std::size_t> next() const;
  double limit_of(std::size_t image) const;
  void triangulate_points();
  bool place_point(TiePoint& point);
  std::optional<double> residual(const TiePoint& point, const Mark& mark) const;
  void drop_outliers();
  void adjust_all(int iterations);
  void adjust_around(std::size_t image);
  std::vector<std::size_t> neighbours(std::size_t image, std::size_t count) const;
  std::vector<std::vector<std::string>> free_parameters() const;

  Reconstruction scene_;
  std::vector<LensGuess> guesses_;
  GrowthSettings settings_;
  std::vector<std::vector<Visible>> marks_;  // by image
  std::vector<std::size_t> failed_at_;       // by image: known points when it failed
};

}  // namespace waymark::pipeline
