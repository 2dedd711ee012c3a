// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <mutex>
namespace waymark {

/// What a unit wrote to one port: in memory, or fetched from the work folder when first read. Thread-safe.
class Artifact {
 public:
  using Value = std::shared_ptr<const void>;

  explicit Artifact(Value value) : value_(std::move(value)) {}
  explicit Artifact(std::function<Value()> load) : load_(std::move(load)) {}

  /// Throws what `load` throws, and tries again at the next call.
  Value value();

 private:
  std::mutex mutex_;
  Value value_;
  std::function<Value()> load_;
};

using ArtifactPtr = std::shared_ptr<Artifact>;

}  // namespace waymark
