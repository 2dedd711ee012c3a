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
namespace waymark {

class LitGround;

enum class Photometry {
  lambert,          ///< cos i
  lommel_seeliger,  ///< 2 cos i / (cos i + cos e): the Moon at small phase
  lunar_lambert,    ///< half of each (McEwen 1991): Mars
};

/// Light and sensor.
struct Exposure {
  Sun sun{Degrees{135}, Degrees{40}};
  Photometry photometry = Photometry::lunar_lambert;
  double skylight = 0.12;     ///< diffuse light as a share of the sun's: 0.1-0.3 Mars, 0.01 Moon
  double haze = 0.05;         ///< light of the air in front of the ground, share of the sunlit ground's
  double psf_sd = 0.6;        ///< pixels, Gaussian
  double read_noise = 0.004;  ///< standard deviation, share of the full scale
  double shot_noise = 0.01;   ///< standard deviation at full scale, share of the full scale
  double level = 0.4;         ///< mean brightness, share of the full scale; 0: no automatic exposure
  double contrast = 1;        ///< stretch about the mean after exposure
  int samples = 3;            ///< per pixel and direction where rocks are near, else 1
};

/// A central camera, or a map seen straight from above.
struct View {
  std::optional<PosedCamera> camera;
  std::int64_t columns = 0, rows = 0;  ///< of a map
  double x0 = 0, y0 = 0, gsd = 1;      ///< of a map: GridFrame of pixel (0, 0), metres per pixel
};
View map_view(const Scene& scene, double gsd, std::int64_t columns, std::int64_t rows);  ///< of its middle
View camera_view(PosedCamera camera);

/// The picture, in [0, 1] (full scale 1), not yet quantised. Pixels that look past the terrain are NaN.
/// `noise_seed` decides the noise alone. The same for any number of threads.
Pixels render_view(const Scene& scene, const View& view, const Exposure& exposure, std::uint64_t noise_seed);
/// The same, for many pictures under one sun: `ground` was made from this scene and exposure.sun.
Pixels render_view(const Scene& scene, const LitGround& ground, const View& view, const Exposure& exposure,
                   std::uint64_t noise_seed);

/// A crater or rock as it appears in a view: the ellipse of its outline on the ground, in pixels.
/// Nothing where a part of it is outside the picture. Occlusion is not looked at.
std::optional<PixelEllipse> outline_in(const View& view, const TrueCrater& crater);
std::optional<PixelEllipse> outline_in(const View& view, const TrueRock& rock);

/// Towards the sun in the picture, radians from x (right) towards y (down), at its middle.
double image_sun_angle(const View& view, const Sun& sun);

}  // namespace waymark
