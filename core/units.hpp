// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <compare>
#include <numbers>
namespace waymark::inline core {

/// Number with a unit. There is no implicit conversion to or from double, nor between units: Meters + Radians
/// does not compile.
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

/// Unit of Meters.
struct MetersUnit {
  static constexpr const char* symbol = "m";
};
/// Unit of Radians.
struct RadiansUnit {
  static constexpr const char* symbol = "rad";
};
/// Unit of Degrees.
struct DegreesUnit {
  static constexpr const char* symbol = "deg";
};

/// Length.
using Meters = Quantity<MetersUnit>;
/// Angle.
using Radians = Quantity<RadiansUnit>;
/// Angle, for options and files.
using Degrees = Quantity<DegreesUnit>;

/// pi / 180.
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180;

/// Converts degrees.
constexpr Radians to_radians(Degrees angle) {
  return {angle.value * kRadiansPerDegree};
}
/// Converts radians.
constexpr Degrees to_degrees(Radians angle) {
  return {angle.value / kRadiansPerDegree};
}

inline namespace literals {
/// Makes a length: 1.5_m.
constexpr Meters operator""_m(long double v) {
  return {static_cast<double>(v)};
}
/// Makes a length: 2_m.
constexpr Meters operator""_m(unsigned long long v) {
  return {static_cast<double>(v)};
}
/// Makes an angle: 0.5_deg.
constexpr Degrees operator""_deg(long double v) {
  return {static_cast<double>(v)};
}
/// Makes an angle: 90_deg.
constexpr Degrees operator""_deg(unsigned long long v) {
  return {static_cast<double>(v)};
}
}  // namespace literals

}  // namespace waymark::inline core
