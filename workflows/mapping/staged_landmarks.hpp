// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/map_contents.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/association/bucket_file.hpp"
namespace waymark::workflows {

/// Landmarks of one source on the disk until a map is written of them. In memory are some thousands of
/// landmarks, those at positions that several share, and about six bytes for each other one.
class StagedLandmarks {
 public:
  /// Temporary files are made in `folder`.
  StagedLandmarks(TypeRegistry types, const std::filesystem::path& folder);

  /// Adds a landmark; one with an empty uid gets a uid by finish().
  void add(Landmark&& landmark);

  /// Gives every landmark its uid, as assign_uids() would after sorting them by type, position, features and
  /// uid, and returns them in parts along a curve. The parts are valid while this object lives. Throws
  /// Error{input} at `source` if two landmarks of a type were added with the same uid.
  geodb::LandmarkParts finish(const Crs& crs, const std::string& source);

 private:
  using Reader = std::function<std::string()>;
  using OfRow = std::unordered_map<std::uint32_t, Landmark>;
  /// What decides the uid of a landmark.
  struct Key {
    double x = 0, y = 0;
    std::uint64_t uid = 0;    ///< hash of the uid that its position gives
    std::uint64_t given = 0;  ///< hash of the uid with which it was added; 0: none
    std::uint32_t row = 0;    ///< in the order of add()
    TypeId type = 0;
  };
  /// Landmarks of a type along the curve through its extent.
  struct Curve {
    geodb::Envelope extent;
    std::vector<std::uint32_t> counts;       ///< by bins of the curve
    std::vector<std::uint32_t> first_parts;  ///< of each bin
  };

  void store_batch();
  void visit(const std::function<void(Landmark&&, std::uint32_t row)>& take) const;
  pipeline::BucketFile make_keys(const Crs& crs);
  OfRow read_tied(const pipeline::BucketFile& keys) const;
  void number_uids(const Crs& crs, const std::string& source);
  std::string made_uid(TypeId type, const Point<MapCrs>& position, std::uint32_t row, const Crs& crs) const;
  std::string final_uid(const Landmark& landmark, std::uint32_t row, const Crs& crs) const;
  void divide_curves();
  std::size_t part_size() const;
  std::size_t next_part(const Landmark& landmark);
  void store_parts(const Crs& crs);

  TypeRegistry types_;
  std::shared_ptr<pipeline::ScratchFile> scratch_;
  std::vector<Landmark> batch_;  ///< not yet on the disk
  std::vector<Reader> batches_;  ///< in the order of add()
  std::size_t count_ = 0;
  std::vector<Curve> curves_;                        ///< by type
  std::unordered_map<std::uint32_t, int> suffixes_;  ///< of rows whose uid is not the first of its kind
  std::vector<std::vector<Reader>> parts_;           ///< pieces of each part
};

}  // namespace waymark::workflows
