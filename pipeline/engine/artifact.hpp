// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
namespace waymark {

/// What a unit wrote to one port: in memory, or fetched from where it was kept when it is read. Thread-safe.
class Artifact {
 public:
  using Value = std::shared_ptr<const void>;
  enum class Once { held, let_go };  ///< what becomes of it once it is fetched and nobody uses it

  explicit Artifact(Value value) : value_(std::move(value)) {}
  explicit Artifact(std::function<Value()> load, Once once = Once::held)
      : load_(std::move(load)), once_(once) {}

  /// Throws what `load` throws, and tries again at the next call.
  Value value();
  /// The same, without keeping it: for the last one who reads it.
  Value hand_over();

 private:
  std::mutex mutex_;
  Value value_;
  std::weak_ptr<const void> used_;  ///< by whom it was fetched for last
  std::function<Value()> load_;
  Once once_ = Once::held;
};

using ArtifactPtr = std::shared_ptr<Artifact>;

/// What it points to: moved out where nobody else holds it, else copied. Artifacts are made as plain T, so
/// that the last owner may do with them as he likes.
template <class T>
T own(Artifact::Value value) {
  const T* const held = static_cast<const T*>(value.get());
  if (value.use_count() == 1) return std::move(*const_cast<T*>(held));
  return *held;
}

}  // namespace waymark
