// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include "core/landmark.hpp"
#include "geodb/geometry_blob.hpp"
namespace waymark {

/// Box around the landmarks at the given indices.
Envelope extent_of(std::span<const Landmark> landmarks, std::span<const std::uint32_t> indices);

/// Orders indices along a Hilbert curve through `extent`, uids deciding between equal places: the order of
/// rows in a map, which does not depend on the order the landmarks came in.
void sort_along_hilbert_curve(std::span<std::uint32_t> indices, std::span<const Landmark> landmarks,
                              const Envelope& extent);

/// Along the curve landmarks lie scattered in memory; asks for those soon after `at` before they are needed.
void fetch_ahead(std::span<const Landmark> landmarks, std::span<const std::uint32_t> indices, std::size_t at);

}  // namespace waymark
