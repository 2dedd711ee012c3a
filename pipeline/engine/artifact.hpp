// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
namespace waymark::pipeline {

/// Value that a unit wrote to one port, held in memory or loaded when it is read. Thread-safe.
class Artifact {
 public:
  using Value = std::shared_ptr<const void>;
  enum class Retention { keep, release };  ///< of a loaded value that is no longer in use

  explicit Artifact(Value value) : value_(std::move(value)) {}
  explicit Artifact(std::function<Value()> load, Retention retention = Retention::keep)
      : load_(std::move(load)), retention_(retention) {}

  /// Returns the value, loading it if necessary. Throws what `load` throws; the next call tries again.
  Value value();
  /// Returns the value without keeping it here. For the last reader.
  Value take();

 private:
  std::mutex mutex_;
  Value value_;
  std::weak_ptr<const void> used_;  ///< the loaded value, while a reader uses it
  std::function<Value()> load_;
  Retention retention_ = Retention::keep;
};

/// Artifact with several readers.
using ArtifactPtr = std::shared_ptr<Artifact>;

/// Returns the pointed-to value: moved if this is the only owner, else copied.
/// Artifacts are created as non-const T, so the cast is valid for the last owner.
template <class T>
T move_or_copy(Artifact::Value value) {
  const T* const held = static_cast<const T*>(value.get());
  if (value.use_count() == 1) return std::move(*const_cast<T*>(held));
  return *held;
}

}  // namespace waymark::pipeline
