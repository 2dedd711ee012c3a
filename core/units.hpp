// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <numbers>
namespace waymark {

/// A number that carries its unit. No implicit conversion to or from double and none between units:
/// Meters + Radians does not compile.
template <class Unit>
struct Quantity {
  double value = 0;

  friend constexpr auto operator<=>(Quantity, Quantity) = default;
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return {a.value + b.value}; }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return {a.value - b.value}; }
  friend constexpr Quantity operator-(Quantity a) { return {-a.value}; }
  friend constexpr Quantity operator*(double k, Quantity a) { return {k * a.value}; }
  friend constexpr Quantity operator*(Quantity a, double k) { return {a.value * k}; }
  friend constexpr Quantity operator/(Quantity a, double k) { return {a.value / k}; }
  friend constexpr double operator/(Quantity a, Quantity b) { return a.value / b.value; }
};

struct MetersUnit {
  static constexpr const char* symbol = "m";
};
struct RadiansUnit {
  static constexpr const char* symbol = "rad";
};
struct DegreesUnit {
  static constexpr const char* symbol = "deg";
};

using Meters = Quantity<MetersUnit>;
using Radians = Quantity<RadiansUnit>;
using Degrees = Quantity<DegreesUnit>;

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

constexpr Radians to_radians(Degrees angle) {
  return {angle.value * kRadiansPerDegree};
}
constexpr Degrees to_degrees(Radians angle) {
  return {angle.value / kRadiansPerDegree};
}

inline namespace literals {
constexpr Meters operator""_m(long double v) {
  return {static_cast<double>(v)};
}
constexpr Meters operator""_m(unsigned long long v) {
  return {static_cast<double>(v)};
}
constexpr Degrees operator""_deg(long double v) {
  return {static_cast<double>(v)};
}
constexpr Degrees operator""_deg(unsigned long long v) {
  return {static_cast<double>(v)};
}
}  // namespace literals

}  // namespace waymark
