// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "localization/drive_statistics.hpp"
namespace waymark::exporters {

/// Returns an SVG page without external references: the median position error of several drives over time,
/// with the bands of half and of 90 % of them. The standard deviation that they claim is dashed. Bands that
/// are empty give empty axes.
std::string error_bands_picture(const std::string& title, std::span<const localization::ErrorBand> bands);

}  // namespace waymark::exporters
