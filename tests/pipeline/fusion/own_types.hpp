// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "landmarks/landmark_type.hpp"
namespace waymark::test {

/// The landmark types of this program.
inline const TypeRegistry kTypes = [] {
  TypeRegistry types;
  register_landmark_types(types);
  return types;
}();

}  // namespace waymark::test
