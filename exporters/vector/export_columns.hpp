// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "core/attribute.hpp"
#include "core/landmark.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// One column of a table of landmarks, named as in the map.
struct ExportColumn {
  std::string name, unit, summary;
  AttributeSpec::Kind kind = AttributeSpec::Kind::real;
  std::function<AttributeValue(const Landmark&)> value;  ///< std::monostate if the landmark has none
};

/// Returns the columns of a type without the geometry, in the order of the map's table: uid; per feature its
/// value, standard deviation (`_sd`) and confidence (`_q`); counts, qualities, covariance (square metres);
/// the attributes.
std::vector<ExportColumn> export_columns(const LandmarkType& type);

/// Returns the landmark quality (eq. 8) with equal weights; `std::nullopt` if none of its terms is known.
std::optional<double> equal_weight_quality(const Landmark& landmark);

}  // namespace waymark::exporters
