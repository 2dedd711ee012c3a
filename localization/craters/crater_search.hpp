// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include "localization/craters/crater_index.hpp"
namespace waymark::localization {

/// Cells of triangles that are alike whatever their scale, turn and position.
namespace crater_cells {
inline constexpr int kMiddle = 20, kShort = 40, kSizes = 13;  // per dimension
inline constexpr double kMinLogSize = -5.2, kSizeStep = 0.4;  // of ln(radius / longest side)
inline constexpr std::size_t kCells = std::size_t{2} * kMiddle * kShort * kSizes * kSizes * kSizes;
inline int middle_cell(double ratio) {
  return std::clamp(static_cast<int>(std::floor((ratio - 0.5) * 2 * kMiddle)), 0, kMiddle - 1);
}
inline int short_cell(double ratio) {
  return std::clamp(static_cast<int>(std::floor(ratio * kShort)), 0, kShort - 1);
}
inline int size_cell(double log_size) {
  return std::clamp(static_cast<int>(std::floor((log_size - kMinLogSize) / kSizeStep)), 0, kSizes - 1);
}
inline std::size_t cell(bool left, int middle, int shortest, const std::array<int, 3>& size) {
  std::size_t k = left;
  k = k * kMiddle + static_cast<std::size_t>(middle);
  k = k * kShort + static_cast<std::size_t>(shortest);
  for (const int s : size) k = k * kSizes + static_cast<std::size_t>(s);
  return k;
}
}  // namespace crater_cells

/// Position proposed by a triangle: similarity from the image, y upwards, to the plane that touches the body
/// at a crater, as complex numbers: plane = factor * image + shift.
struct CraterGuess {
  std::uint32_t anchor = 0;
  std::array<std::uint32_t, 3> seen{}, mapped{};
  std::complex<double> factor, shift;
  double score = 0;
};

/// Plane that touches the body at a crater.
struct CraterPlane {
  Eigen::Vector3d origin, east, north;
  Eigen::Vector3d point(std::complex<double> p) const { return origin + p.real() * east + p.imag() * north; }
  std::complex<double> flat(const Eigen::Vector3d& p) const {
    return {east.dot(p - origin), north.dot(p - origin)};
  }
};

/// One search: triangles propose positions, and the craters around score them.
class CraterSearch {
 public:
  CraterSearch(const CraterIndex& index, const CraterImage& image, const CraterSearchOptions& options);
  CraterAnswer find() const;

  /// Returns the standard deviation of a detection's position, px, without that of its crater.
  double sd(std::size_t seen) const;

 private:
  struct Triangle {
    std::array<std::uint32_t, 3> corners;  // the longest side opposite the first
    std::array<double, 3> side, slack;
    double weight;
  };
  std::vector<Triangle> image_triangles() const;
  std::optional<Triangle> ordered(std::array<std::uint32_t, 3> c) const;
  /// Positions that a triangle proposes.
  struct Proposals {
    std::vector<CraterGuess> likely = {};
    std::size_t scored = 0;
  };
  void look_up(const Triangle& t, Proposals& into) const;
  void compare(const Triangle& t, const CraterIndex::Corners& mapped, Proposals& into) const;
  bool is_possible_scale(double scale) const;
  double score(const CraterGuess& guess, const CraterPlane& plane) const;
  CraterPlane plane_at(std::uint32_t crater) const;
  std::optional<CraterFix> fit(const CraterGuess& guess) const;
  void keep(std::vector<CraterFix>& fixes, CraterFix fix) const;
  std::string_view verdict(const CraterAnswer& answer) const;

  const CraterIndex& index_;
  const CraterImage& image_;
  const CraterSearchOptions& o_;
  std::vector<std::uint32_t> used_;  // detections, the largest first
};

/// Adjusts positions to all craters of an image.
class CraterFitter {
 public:
  CraterFitter(const CraterIndex& index, const CraterImage& image, const CraterSearchOptions& options,
               std::span<const std::uint32_t> used);
  /// Returns the least-squares position near a first one, with the first matches; `std::nullopt` if too few
  /// craters match.
  std::optional<CraterFix> fit(ImagePose pose, std::span<const std::uint32_t> seen,
                               std::span<const std::uint32_t> mapped) const;

 private:
  using Jacobian = Eigen::Matrix<double, 2, ImagePose::kParameters>;
  using Matches = std::vector<std::optional<std::uint32_t>>;  // of the used detections
  Jacobian jacobian(const ImagePose& pose, std::uint32_t crater) const;
  double variance(std::uint32_t seen, std::uint32_t mapped, double pixels_per_metre) const;
  std::optional<ImagePoint> project(const ImagePose& pose, std::uint32_t crater) const;
  /// Moves the pose by Gauss-Newton steps, and computes covariance and residual.
  bool adjust(CraterFix& fix, const Matches& matches) const;
  Matches match(const CraterFix& fix) const;
  void evaluate(CraterFix& fix, const Matches& matches) const;
  double craters_in_view(const ImagePose& pose) const;
  int free_parameters() const { return image_.camera.focal() > 0 ? ImagePose::kParameters : 4; }

  const CraterIndex& index_;
  const CraterImage& image_;
  const CraterSearchOptions& o_;
  std::span<const std::uint32_t> used_;
  Eigen::Vector2d half_;                    // of the image, px
  std::vector<double> clutter_;             // density of arbitrary detections per px^2 and ln of radius
  double min_radius_ = 0, max_radius_ = 0;  // px
};

}  // namespace waymark::localization
