// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include "core/detection.hpp"
#include "geo/camera.hpp"
#include "geo/georeference.hpp"
#include "geo/image_source.hpp"
#include "geo/sun.hpp"
#include "testbed/scene.hpp"
namespace waymark::testbed {

class LitTerrain;

enum class Photometry {
  lambert,          ///< cos i
  lommel_seeliger,  ///< 2 cos i / (cos i + cos e): the Moon at small phase
  lunar_lambert,    ///< half of each (McEwen 1991): Mars
};

/// Illumination and sensor.
struct Exposure {
  Sun sun{Degrees{135}, Degrees{40}};
  Photometry photometry = Photometry::lunar_lambert;
  double skylight = 0.12;     ///< diffuse over direct light: 0.1-0.3 Mars, 0.01 Moon
  double haze = 0.05;         ///< path radiance, fraction of that of sunlit ground
  double psf_sd = 0.6;        ///< pixels, Gaussian
  double read_noise = 0.004;  ///< standard deviation, fraction of full scale
  double shot_noise = 0.01;   ///< standard deviation at full scale, fraction of full scale
  double level = 0.4;         ///< mean brightness, fraction of full scale; 0: no automatic exposure
  double contrast = 1;        ///< stretch about the mean after exposure
  double exposure_time = 0;   ///< s: motion blurs the image
  double readout_time = 0;    ///< s from the first row to the last: a rolling shutter; 0: global
  int samples = 3;            ///< per pixel and direction near rocks, else 1
};

/// Motion of a camera while it takes an image, GridFrame.
struct CameraMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< rad/s
};

/// Dust that rockets raise below a lander.
struct DustCloud {
  double depth = 0;                                  ///< largest optical depth, vertical; 0: none
  double radius = 0;                                 ///< metres at which the depth has fallen to 1 / e
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< GridFrame
  std::uint64_t seed = 0;                            ///< of its billows
};

/// Round shield that falls away below a lander.
struct FallingShield {
  double radius = 0;                                 ///< metres; 0: none
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< GridFrame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Central camera, or a vertical map view.
struct View {
  std::optional<PosedCamera> camera;  ///< its pose is that of the middle row at the middle of the exposure
  CameraMotion motion = {};
  DustCloud dust = {};
  FallingShield shield = {};
  std::int64_t columns = 0, rows = 0;  ///< size of a map view
  double x0 = 0, y0 = 0, gsd = 1;      ///< map view: GridFrame of pixel (0, 0), metres per pixel
};
View map_view(const Scene& scene, double gsd, std::int64_t columns,
              std::int64_t rows);  ///< about the centre of the scene
View camera_view(PosedCamera camera, const CameraMotion& motion = {});

/// Returns the optical depth of dust over a point of the ground, straight up.
double dust_depth(const DustCloud& dust, double x, double y);

/// Renders an image in [0, 1] (full scale 1), not quantised. Pixels that look past the terrain are NaN.
/// `noise_seed` affects the noise only. The result does not depend on the number of threads.
Pixels render_view(const Scene& scene, const View& view, const Exposure& exposure, std::uint64_t noise_seed);
/// Renders one of many images under one sun: `ground` was made from this scene and exposure.sun.
Pixels render_view(const Scene& scene, const LitTerrain& ground, const View& view, const Exposure& exposure,
                   std::uint64_t noise_seed);

/// Projects the ground outline of a crater or rock into a view as an ellipse, in pixels. `std::nullopt` if
/// a part is outside the image. Occlusion is ignored.
std::optional<PixelEllipse> image_outline(const View& view, const TrueCrater& crater);
std::optional<PixelEllipse> image_outline(const View& view, const TrueRock& rock);

/// Returns the direction towards the sun at the image centre, radians from x (right) towards y (down).
double image_sun_angle(const View& view, const Sun& sun);

}  // namespace waymark::testbed
