// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <unordered_set>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/parts.hpp"
#include "pipeline/fusion/association/bucket_file.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
namespace waymark::pipeline {

/// Finds landmarks of different parts that share a uid, which have nearly the same position. Numbers them as
/// assign_uids() does for all landmarks at once. Eight bytes per landmark on disk.
class RepeatedUids {
 public:
  /// The types must outlive it.
  RepeatedUids(const TypeRegistry& types, const Crs& crs, std::shared_ptr<ScratchFile> file);

  /// Adds the landmarks of a part.
  void add(std::uint32_t part, std::span<const Landmark> landmarks);

  /// Numbers again what assign_uids() has numbered part by part. Writes the parts that change once more.
  void number(PartsWriter<std::vector<Landmark>>& landmarks,
              PartsWriter<std::vector<Observation>>& evidence) const;

 private:
  /// Hashes of uids of several parts, and those parts.
  struct Found {
    std::unordered_set<std::uint64_t> hashes;
    std::set<std::uint32_t> parts;
  };
  Found find() const;
  std::uint64_t hash(const Landmark& landmark) const;

  const TypeRegistry* types_;
  Crs crs_;
  BucketFile keys_;
};

}  // namespace waymark::pipeline
