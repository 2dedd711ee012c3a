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

/// Returns a catalogue of one type, whose landmarks are lines.
inline TypeRegistry edges() {
  TypeRegistry types;
  types.add({.name = "edge",
             .summary = "A line",
             .features = {{"direction", "rad", Scale::direction, -4, 4, "Normal, clockwise from north", 0.05},
                          {"length", "m", Scale::ratio, 0.1, 1000, "Length"}}});
  return types;
}

}  // namespace waymark::test
