// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark {

/// Stem volume and dry mass of a tree from its diameter and height: V = f pi / 4 D^2 H with the form factor
/// f, M = V density expansion.
struct VolumeRow {
  std::string species = "all";   ///< "all": of any other species
  double form_factor = 0.47;     ///< of the volume over bark to the tip, (0, 1]
  double form_factor_sd = 0.04;  ///< of the factor of a whole stand: all its trees err alike
  /// Basic density, kg / m3, times what crown and bark add; NaN: no mass is told.
  double mass_per_volume = std::numeric_limits<double>::quiet_NaN();
  std::string source;
};

/// The table used where none is given: f = 0.47 +- 0.04 for every species, the middle of the 0.42 to 0.52 of
/// textbooks for mature temperate stands (van Laar & Akca 2007, Forest Mensuration, ch. 7). Replace it where
/// volumes matter.
const std::vector<VolumeRow>& built_in_volume();

/// The row of a species, by name without regard to case; else the row "all"; null where there is neither.
const VolumeRow* volume_of(std::span<const VolumeRow> table, std::string_view species);

/// Cubic metres; metres in.
double stem_volume(const VolumeRow& row, double diameter, double height);

/// CSV with the columns species and form_factor; form_factor_sd, mass_per_volume and source may be missing.
/// Throws Error{input} that names the line.
std::vector<VolumeRow> parse_volume(std::string_view csv, std::string_view file);

/// How many of the trees of a height are found: rows by rising height, each good up to the next.
struct RecallRow {
  double height_from = 0;  ///< metres
  double recall = 1;       ///< (0, 1]
  double sd = 0;           ///< of the recall
};

/// CSV with the columns height_from and recall; sd may be missing. Throws Error{input} that names the line.
std::vector<RecallRow> parse_recall(std::string_view csv, std::string_view file);

}  // namespace waymark
