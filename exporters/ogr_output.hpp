// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "core/landmark.hpp"
#include "exporters/vector_format.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// A new file or database that OGR writes, one layer per landmark type.
class OgrOutput {
 public:
  /// `path` is where it is written, `shown_as` the name messages use. Throws Error{output}.
  OgrOutput(const VectorFormat& format, const std::string& path, std::string shown_as);
  ~OgrOutput();

  /// Writes a layer of points with the columns of export_columns(). Formats with a name and a description for
  /// every place (KML, GPX, GeoRSS) get them. Throws Error{output} for what cannot be written.
  void add_layer(const LandmarkType& type, const std::vector<Landmark>& landmarks, const Crs& crs);

  /// Finishes the file and returns what the format could not keep. Throws Error{output}: the disk may be full
  /// only now.
  std::vector<std::string> close();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace waymark
