// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "geodb/map_contents.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/store/scratch_file.hpp"
namespace waymark::workflows {

/// Landmarks of one source on the disk until a map is written of them. Memory is about 40 bytes per landmark,
/// and some thousands of landmarks.
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
  /// What is kept in memory of a landmark.
  struct Key {
    double x = 0, y = 0;
    std::uint32_t row = 0;  ///< in the order of add()
    TypeId type = 0;
  };

  void store_batch();
  void visit(const std::function<void(Landmark&&, std::uint32_t row)>& take) const;
  void sort_keys();
  std::vector<std::uint64_t> assign_final_uids(const Crs& crs);
  std::string final_uid(Landmark& landmark, std::uint32_t row, const Crs& crs) const;
  void refuse_duplicates(const std::vector<std::uint64_t>& uids, const Crs& crs,
                         const std::string& source) const;
  std::vector<std::uint32_t> part_of_rows();
  void store_parts(const Crs& crs);

  TypeRegistry types_;
  pipeline::ScratchFile scratch_;
  std::vector<Landmark> batch_;  ///< not yet on the disk
  std::vector<Reader> batches_;  ///< in the order of add()
  std::vector<Key> keys_;
  std::vector<std::uint64_t> given_;                 ///< hash of the uid given to a row; 0: none
  std::unordered_map<std::uint32_t, int> suffixes_;  ///< of rows whose uid is not the first of its kind
  std::vector<std::vector<Reader>> parts_;           ///< pieces of each part
};

}  // namespace waymark::workflows
