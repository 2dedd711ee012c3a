// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::pipeline {

/// Stem volume and dry mass of a tree from its diameter and height: V = f pi / 4 D^2 H with form factor f,
/// M = V times mass_per_volume.
struct VolumeRow {
  std::string species = "all";   ///< "all": any other species
  double form_factor = 0.47;     ///< for volume over bark to the tip, (0, 1]
  double form_factor_sd = 0.04;  ///< of the mean factor of a stand, common to all its trees
  /// Basic density, kg / m3, times an expansion factor for crown and bark; NaN: no mass is computed.
  double mass_per_volume = std::numeric_limits<double>::quiet_NaN();
  std::string source;
};

/// Returns the default table: f = 0.47 +- 0.04 for every species. It is the middle of 0.42 to 0.52 for mature
/// temperate stands (van Laar & Akca 2007, Forest Mensuration, ch. 7). Replace it where volumes matter.
const std::vector<VolumeRow>& built_in_volume();

/// Returns the row of a species (case-insensitive), else the row "all", else null.
const VolumeRow* volume_of(std::span<const VolumeRow> table, std::string_view species);

/// Returns cubic metres; arguments in metres.
double stem_volume(const VolumeRow& row, double diameter, double height);

/// Reads CSV with the columns species and form_factor; form_factor_sd, mass_per_volume and source are
/// optional. Throws Error{input} naming the line.
std::vector<VolumeRow> parse_volume(std::string_view csv, std::string_view file);

/// Fraction of trees detected, from a height up to that of the next row; rows by ascending height.
struct RecallRow {
  double height_from = 0;  ///< metres
  double recall = 1;       ///< (0, 1]
  double sd = 0;           ///< of the recall
};

/// Reads CSV with the columns height_from and recall; sd is optional. Throws Error{input} naming the line.
std::vector<RecallRow> parse_recall(std::string_view csv, std::string_view file);

}  // namespace waymark::pipeline
