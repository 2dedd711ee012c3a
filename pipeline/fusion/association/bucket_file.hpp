// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/store/scratch_file.hpp"
namespace waymark::pipeline {

/// Bytes by bucket on disk, appended in any order. All buckets together hold `buffered` bytes in memory.
class BucketFile {
 public:
  BucketFile(std::shared_ptr<ScratchFile> file, std::size_t buckets, std::size_t buffered = kBuffered);

  void add(std::size_t bucket, std::string_view bytes);
  /// Returns all bytes of a bucket in the order they were added. Thread-safe while nothing is added.
  std::string read(std::size_t bucket) const;
  /// Releases the memory of a bucket, which is empty then.
  void forget(std::size_t bucket) { buckets_[bucket] = {}; }

  static constexpr std::size_t kBuffered = std::size_t{32} << 20;

 private:
  struct Bucket {
    std::vector<std::function<std::string()>> pieces;
    std::string buffer;
  };
  std::shared_ptr<ScratchFile> file_;
  std::vector<Bucket> buckets_;
  std::size_t piece_;  ///< bytes
};

}  // namespace waymark::pipeline
