// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>
namespace waymark::inline core {

/// Fact about a landmark that is not an observed feature, e.g. the position of the key saddle of a summit.
/// An attribute has no spread, is never merged, and has its own column in the map.
struct AttributeSpec {
  enum class Kind { real, integer, text };
  std::string name, unit;
  Kind kind = Kind::real;
  std::string summary;
};

/// Value of an attribute; std::monostate is NULL.
using AttributeValue = std::variant<std::monostate, double, std::int64_t, std::string>;

/// One value per AttributeSpec of the type, in the order of the specs.
using AttributeSet = std::vector<AttributeValue>;

}  // namespace waymark::inline core
