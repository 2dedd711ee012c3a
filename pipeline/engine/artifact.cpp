// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/artifact.hpp"

namespace waymark {

Artifact::Value Artifact::value() {
  const std::lock_guard lock(mutex_);
  if (!value_) value_ = load_();
  return value_;
}

Artifact::Value Artifact::hand_over() {
  Value last = value();
  const std::lock_guard lock(mutex_);
  value_.reset();
  return last;
}

}  // namespace waymark
