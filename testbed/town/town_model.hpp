// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
namespace waymark::testbed {

/// A straight street between two rows of houses. Lengths in metres.
struct StreetModel {
  bool on = false;
  double length = 150;
  double width = 16;              ///< between the facades
  double max_setback = 2;         ///< of a house behind the line of the street
  double house_length = 12;       ///< mean
  double pole_spacing = 18;       ///< of the lamps of one side
  double bollards = 0.15;         ///< per metre of street, in groups
  double sign_spacing = 30;       ///< of traffic signs of one side
  double tree_spacing = 25;       ///< of the trees of one side
  double reflector_spacing = 0;   ///< of reflecting posts of one side; 0: none
  double parked = 0.5;            ///< fraction of the parking spaces taken; others in each drive
  double overhang = 0.3;          ///< of the eaves beyond the walls
  double survey_pulses = 0;       ///< of an airborne laser survey, per square metre; 0: none
  double survey_shift_sd = 0.05;  ///< of the survey as a whole, each axis
};

/// A floor of a building: a corridor around a core, with rooms outside. Lengths in metres.
struct HallModel {
  bool on = false;
  double length = 36, width = 24;  ///< of the middle line of the corridor
  double corridor_width = 2.4;
  double room_depth = 5;
  double room_width = 4;        ///< mean
  double room_variation = 0.3;  ///< relative; 0: rooms all alike
  double doors_open = 0.5;      ///< fraction, drawn for each drive
  double door_width = 0.95;
  std::int64_t pillars = 6;  ///< in the corridor
  std::int64_t people = 3;   ///< walking in the corridor
  bool symmetric =
      false;  ///< the second half is the first one turned by half a turn: positions are ambiguous
};

}  // namespace waymark::testbed
