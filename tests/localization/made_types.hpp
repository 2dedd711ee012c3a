// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "landmarks/landmark_type.hpp"
namespace waymark::test {

/// Returns a catalogue of one type, whose only feature is an axis.
inline TypeRegistry ellipses() {
  TypeRegistry types;
  types.add(
      {.name = "ellipse",
       .summary = "Something long",
       .features = {{"orientation", "rad", Scale::axis, -4, 4, "Long axis, clockwise from north", 0.8}}});
  return types;
}

}  // namespace waymark::test
