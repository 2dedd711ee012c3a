// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// All landmarks of one type, ranked by the feature that sizes their symbol (by its certified lower bound
/// where there is one), else by confidence; unknown values last, ties by uid.
struct LandmarkSection {
  LandmarkType type;
  std::vector<Landmark> landmarks;
};
std::vector<LandmarkSection> landmark_sections(const geodb::MapStore& map);

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

/// Returns all known values of a feature, unsorted.
std::vector<double> known_values(const LandmarkSection& section, std::size_t feature);

}  // namespace waymark::exporters
