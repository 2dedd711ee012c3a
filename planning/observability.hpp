// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <iterator>
#include <string_view>
#include <utility>
#include "planning/information_field.hpp"
#include "planning/segment.hpp"
namespace waymark::planning {

/// How well a vehicle can be localized at a place.
struct Observability {
  /// After a drive on a straight line from an exactly known pose, with the landmarks of this place in sight
  /// all the time; of the least favourable of eight headings.
  double position_sd = 0, yaw_sd = 0;  ///< metres, in the worst direction; radians
  Information mean;                    ///< over the headings
  double landmarks = 0;                ///< in sight, mean over the headings
};

struct ObservabilityRules {
  LandmarkSensing sensing = {};
  localization::OdometryNoise noise = {};
  double drive = 100;  ///< metres
};

/// Returns the observability at a position of the map frame. 8 x 7 star products: 25 us.
Observability observability_at(double x, double y, const localization::LandmarkGrid& map,
                               const ObservabilityRules& rules);

/// Observability at many positions of one map. Where no landmark is in sight it is that of the odometry,
/// which is computed once: 0.1 us. Thread-safe; `map` and `rules` must outlive it.
class ObservabilityField {
 public:
  ObservabilityField(const localization::LandmarkGrid& map, const ObservabilityRules& rules);
  /// Returns the same as observability_at(), to the last bit.
  Observability at(double x, double y) const;

 private:
  const localization::LandmarkGrid& map_;
  const ObservabilityRules& rules_;
  Observability unseen_;
};

/// Bands of the raster and their units.
inline constexpr std::pair<std::string_view, std::string_view> kObservabilityBands[] = {
    {"position_sd", "m"},
    {"yaw_sd", "degree"},
    {"landmarks", ""},
    {"quality", ""},
    {"information_east", "m-2/m"},
    {"information_north", "m-2/m"},
    {"information_east_north", "m-2/m"},
    {"information_yaw", "rad-2/m"}};

/// Returns the values of the bands.
std::array<double, std::size(kObservabilityBands)> observability_bands(const Observability& at);

}  // namespace waymark::planning
