// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include "geo/geocentric.hpp"
namespace waymark::localization {

/// Surface of a body at height 0, an ellipsoid of revolution. Coordinates are metres from its centre, x
/// through the prime meridian, z through the north pole.
class BodySurface {
 public:
  explicit BodySurface(const Body& body)
      : body_(body), equatorial_(body.equatorial_radius), polar_(body.polar_radius()) {}

  /// Returns the point at a longitude and geodetic latitude, degrees, and a height, metres.
  Eigen::Vector3d point(LonLat at, double height = 0) const { return geocentric(body_, {at, height}); }
  Geodetic geodetic(const Eigen::Vector3d& point) const { return geo::geodetic(body_, point); }
  Eigen::Vector3d up(const Eigen::Vector3d& on_surface) const;
  /// Returns the point of the surface in the direction of a point from the centre.
  Eigen::Vector3d nearest(const Eigen::Vector3d& point) const;
  /// Returns the first point that a ray hits; `std::nullopt` if it misses.
  std::optional<Eigen::Vector3d> hit(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const;
  double area() const;  ///< square metres, of the sphere of equal volume
  double radius() const { return equatorial_; }

 private:
  Eigen::Vector3d squeezed(const Eigen::Vector3d& p) const {
    return {p.x() / equatorial_, p.y() / equatorial_, p.z() / polar_};
  }
  Body body_;
  double equatorial_, polar_;
};

/// Position and attitude of an image of the ground that looks nearly straight down.
struct ImagePose {
  static constexpr int kParameters = 6;
  using Step = Eigen::Matrix<double, kParameters, 1>;
  using Covariance = Eigen::Matrix<double, kParameters, kParameters>;

  Eigen::Vector3d ground = Eigen::Vector3d::UnitX();  ///< of the middle of the image, on the surface
  /// Columns: right and down in an image without tilt, and down to the ground; unit vectors.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double log_scale = 0;                            ///< ln of metres per pixel at the middle
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< rad off the vertical, about image x and y

  /// Returns the pose moved by metres right and down, ln of scale, a clockwise turn, and two tilts.
  ImagePose moved(const Step& step, const BodySurface& surface) const;
  /// Returns the direction of the upward edge of the image, rad clockwise from north.
  double azimuth() const;
};

/// Returns the pose without tilt whose middle is on the surface at `ground`.
ImagePose image_pose(const BodySurface& surface, const Eigen::Vector3d& ground, double metres_per_pixel,
                     double azimuth);

/// Point in an image: pixels right and down from its middle, and pixels per metre of the ground there.
struct ImagePoint {
  Eigen::Vector2d at;
  double pixels_per_metre;
};

/// Camera without distortion, whose axis passes through the middle of the image.
class GroundCamera {
 public:
  /// `focal` in pixels; 0: parallel rays, as of an orthophoto.
  explicit GroundCamera(double focal = 0) : focal_(focal) {}

  double focal() const { return focal_; }
  /// Returns the image of a point with unit normal `up`; `std::nullopt` behind the horizon or the camera.
  std::optional<ImagePoint> project(const ImagePose& pose, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& up) const;
  /// Returns the ground at a pixel; `std::nullopt` in the sky.
  std::optional<Eigen::Vector3d> ground(const ImagePose& pose, const Eigen::Vector2d& pixel,
                                        const BodySurface& surface) const;
  /// Returns the position of the camera; `std::nullopt` for parallel rays.
  std::optional<Eigen::Vector3d> position(const ImagePose& pose) const;

 private:
  Eigen::Matrix3d tilted_axes(const ImagePose& pose) const;
  double focal_;
};

}  // namespace waymark::localization
