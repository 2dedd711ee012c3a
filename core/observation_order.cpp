// SPDX-License-Identifier: Apache-2.0
#include "core/observation_order.hpp"

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <tuple>

namespace waymark::inline core {
namespace {

// Maps doubles to integers of the same total order, NaN included.
std::int64_t rank(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits < 0 ? static_cast<std::int64_t>(0x8000000000000000u) - bits : bits;
}

int compare(std::int64_t a, std::int64_t b) {
  return a < b ? -1 : a > b ? 1 : 0;
}

template <class Matrix>
int compare(const Matrix& a, const Matrix& b) requires requires {
  a.reshaped();
}
{
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if (const int c = compare(rank(a.reshaped()[i]), rank(b.reshaped()[i]))) return c;
  return 0;
}

int compare(const FeatureSet& a, const FeatureSet& b) {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (const int c = compare(rank(a[i].value), rank(b[i].value))) return c;
    if (const int c = compare(rank(a[i].variance), rank(b[i].variance))) return c;
    if (const int c = compare(a[i].observations, b[i].observations)) return c;
  }
  return 0;
}

}  // namespace

bool comes_before(const Observation& a, const Observation& b) {
  if (a.type != b.type) return a.type < b.type;
  if (const int c = a.source.compare(b.source)) return c < 0;
  if (const int c = compare(a.position.xyz, b.position.xyz)) return c < 0;
  if (a.pixel.has_value() != b.pixel.has_value()) return b.pixel.has_value();
  if (a.pixel)
    if (const int c = compare(*a.pixel, *b.pixel)) return c < 0;
  if (const int c = compare(rank(a.confidence), rank(b.confidence))) return c < 0;
  if (const int c = compare(a.features, b.features)) return c < 0;
  if (const int c = compare(a.covariance, b.covariance)) return c < 0;
  return std::tie(a.rejected, a.landmark_uid) < std::tie(b.rejected, b.landmark_uid);
}

}  // namespace waymark::inline core
