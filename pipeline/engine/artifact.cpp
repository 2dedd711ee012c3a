// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/artifact.hpp"

namespace waymark::pipeline {

Artifact::Value Artifact::value() {
  const std::lock_guard lock(mutex_);
  if (value_) return value_;
  if (Value used = used_.lock()) return used;
  Value fetched = load_();
  if (retention_ == Retention::keep)
    value_ = fetched;
  else
    used_ = fetched;
  return fetched;
}

Artifact::Value Artifact::take() {
  Value last = value();
  const std::lock_guard lock(mutex_);
  value_.reset();
  return last;
}

}  // namespace waymark::pipeline
