// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
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

/// Appends a value to a bucket, bit by bit.
template <class Value>
requires std::is_trivially_copyable_v<Value>
void add_value(BucketFile& file, std::size_t bucket, const Value& value) {
  file.add(bucket, {reinterpret_cast<const char*>(&value), sizeof value});
}

/// Returns the values of a bucket that has no others, in the order they were added.
template <class Value>
requires std::is_trivially_copyable_v<Value> std::vector<Value> read_values(const BucketFile& file,
                                                                            std::size_t bucket) {
  const std::string bytes = file.read(bucket);
  std::vector<Value> values(bytes.size() / sizeof(Value));
  std::copy_n(bytes.data(), bytes.size(), reinterpret_cast<char*>(values.data()));
  return values;
}

}  // namespace waymark::pipeline
