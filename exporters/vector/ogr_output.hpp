// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "exporters/vector/vector_format.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::exporters {

/// Landmarks of a layer, one at a time; may be called several times and visits the same landmarks each time.
using LandmarkStream = std::function<void(const std::function<void(const Landmark&)>& visit)>;

/// A new file or database that OGR writes, one layer per landmark type.
class OgrOutput {
 public:
  /// Creates the file `path`; messages name it `output_name`. Throws Error{output}.
  OgrOutput(const VectorFormat& format, const std::string& path, std::string output_name);
  ~OgrOutput();

  /// Writes a layer of points with the columns of export_columns(). Formats with placemarks (KML, GPX,
  /// GeoRSS) get a name and a description for each. No landmark stays in memory. Throws Error{output}.
  void add_layer(const LandmarkType& type, const LandmarkStream& landmarks, const Crs& crs);

  /// Finishes the file and returns the losses of the format. Throws Error{output}, for a full disk possibly
  /// only now.
  std::vector<std::string> close();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace waymark::exporters
