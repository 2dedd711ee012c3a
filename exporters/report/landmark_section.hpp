// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "exporters/report/relief_source.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// Mean of the known values.
class Mean {
 public:
  /// Ignores missing values and those that are not finite.
  void add(std::optional<double> value);
  /// Returns `std::nullopt` without a value.
  std::optional<double> value() const;

 private:
  double sum_ = 0;
  std::int64_t count_ = 0;
};

/// How well the landmarks of a type were observed.
struct ObservationMeans {
  std::int64_t several = 0;  ///< landmarks seen in more than one image
  Mean seen, visible, multiplicity, spread, quality, confidence;
};

/// What a report shows of the landmarks of one type. It holds the foremost landmarks only, and 8 bytes per
/// feature of each of the others.
struct LandmarkSection {
  /// Landmarks that are held unless more are asked for.
  static constexpr std::size_t kMaxRanked = 5000;

  LandmarkType type;
  std::int64_t count = 0;  ///< of all landmarks
  /// The foremost, ranked by the feature that sizes their symbol (by its certified lower bound where there is
  /// one), else by confidence; unknown values last, ties by uid.
  std::vector<Landmark> landmarks = {};
  std::vector<std::vector<double>> values = {};  ///< the known values of each feature, unsorted
  std::optional<Extent> extent = {};             ///< of all positions
  std::optional<Extent> eastern_extent = {};     ///< the same with longitudes from 0 to 360
  ObservationMeans observed = {};
};

/// Calls its argument for each landmark of a type.
using LandmarkVisit = std::function<void(const std::function<void(Landmark&&)>& take)>;

/// Collects a section from one visit of the landmarks, with up to `max_ranked` of them.
LandmarkSection landmark_section(const LandmarkType& type, const LandmarkVisit& visit,
                                 std::size_t max_ranked = LandmarkSection::kMaxRanked);
/// Collects the sections of a map's types, with `max_ranked` landmarks or kMaxRanked if that is more.
std::vector<LandmarkSection> landmark_sections(const geodb::MapStore& map, std::size_t max_ranked);

/// Returns the index of the feature of that name; `std::nullopt` for an empty or unknown name.
std::optional<std::size_t> find_feature(const LandmarkType& type, const std::string& name);

/// Returns the value of a feature; NaN if it is unknown.
double value_of(const Landmark& landmark, std::optional<std::size_t> feature);

/// Returns the index of the attribute that bounds a feature from below, e.g. prominence_low; `std::nullopt`
/// if the type has none.
std::optional<std::size_t> lower_bound_of(const LandmarkType& type, const std::string& feature);

/// Returns the value that ranks a landmark among its type: the certified lower bound of the feature if there
/// is one, else its value; NaN if it is unknown.
double certified_value(const LandmarkType& type, const Landmark& landmark, const std::string& feature);

}  // namespace waymark::exporters
