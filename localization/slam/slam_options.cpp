// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/slam_options.hpp"

namespace waymark::localization {

void SlamOptions::describe(OptionVisitor& option) {
  option("slam_match", match,
         {.help = "Squared Mahalanobis distance up to which a sighting matches a landmark", .min = 0});
  option("slam_new_landmark", fresh,
         {.help = "Squared Mahalanobis distance beyond which a sighting is a new landmark",
          .min = 0,
          .formerly = "slam_fresh"});
  option("slam_min_spacing", nearest,
         {.help = "Smallest distance between two landmarks, metres", .min = 0, .formerly = "slam_nearest"});
  option("slam_range", max_range, {.help = "Largest range of sightings, metres", .min = 0.1});
  option("slam_seen", seen, {.help = "Log odds of existence that a match adds", .min = 0});
  option("slam_unseen", unseen, {.help = "Log odds of existence that a missed detection adds", .max = 0});
  option("slam_confirmed", confirmed, {.help = "Log odds from which a landmark is written to a map"});
  option("slam_dropped", dropped, {.help = "Log odds below which a landmark is removed"});
  option("slam_view", field_of_view,
         {.help = "Radians to each side where sightings are expected", .min = 0, .max = 3.15});
  option("slam_margin", margin,
         {.help = "Metres driven between two updates of the landmarks out of sight", .min = 0.1});
  option("slam_feature_tolerance", feature_tolerance,
         {.help = "Relative standard deviation between two sightings of a landmark", .min = 1e-3, .max = 10});
  option("slam_feature_limit", feature_limit,
         {.help = "Squared standard deviations by which a feature may differ", .min = 0});
}

}  // namespace waymark::localization
