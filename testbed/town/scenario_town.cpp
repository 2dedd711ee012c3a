// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario_sections.hpp"

namespace waymark::testbed {

void describe_street(Scenario& s, OptionVisitor& field) {
  StreetModel& m = s.street;
  field("length", m.length, {.help = "Length, metres", .min = 30, .max = 1e4});
  field("width", m.width, {.help = "Between the facades, metres", .min = 10, .max = 100});
  field("max_setback", m.max_setback,
        {.help = "Of a house behind the line of the street, metres", .min = 0, .max = 20});
  field("house_length", m.house_length, {.help = "Mean length of a house, metres", .min = 3, .max = 200});
  field("pole_spacing", m.pole_spacing,
        {.help = "Spacing of the lamps of a side, metres; 0: none", .min = 0, .max = 1e3});
  field("bollards", m.bollards, {.help = "Bollards per metre of street", .min = 0, .max = 2});
  field("sign_spacing", m.sign_spacing,
        {.help = "Spacing of the signs of a side, metres; 0: none", .min = 0, .max = 1e3});
  field("tree_spacing", m.tree_spacing,
        {.help = "Spacing of the trees of a side, metres; 0: none", .min = 0, .max = 1e3});
  field(
      "reflector_spacing", m.reflector_spacing,
      {.help = "Spacing of posts with reflecting tape of a side, metres; 0: none. With them the line scanner "
               "logs intensities",
       .min = 0,
       .max = 1e3});
  field("parked", m.parked,
        {.help = "Fraction of the parking spaces taken, others in each drive", .min = 0, .max = 1});
  field("overhang", m.overhang, {.help = "Of the eaves beyond the walls, metres", .min = 0, .max = 2});
  field("survey_pulses", m.survey_pulses,
        {.help = "Pulses per square metre of an airborne laser survey; 0: none", .min = 0, .max = 200});
  field("survey_shift_sd", m.survey_shift_sd,
        {.help = "Standard deviation of its shift as a whole, metres", .min = 0, .max = 10});
}

void describe_hall(Scenario& s, OptionVisitor& field) {
  HallModel& m = s.hall;
  field("length", m.length, {.help = "Of the middle line of the corridor, metres", .min = 10, .max = 500});
  field("width", m.width, {.help = "Of the middle line of the corridor, metres", .min = 10, .max = 500});
  field("corridor_width", m.corridor_width, {.help = "Metres", .min = 1.5, .max = 8});
  field("room_depth", m.room_depth, {.help = "Metres", .min = 2, .max = 30});
  field("room_width", m.room_width, {.help = "Mean, metres", .min = 2, .max = 50});
  field("room_variation", m.room_variation,
        {.help = "Relative variation; 0: rooms all alike", .min = 0, .max = 0.5});
  field("doors_open", m.doors_open,
        {.help = "Fraction of the doors open, drawn for each drive", .min = 0, .max = 1});
  field("door_width", m.door_width, {.help = "Metres", .min = 0.6, .max = 1.5});
  field("pillars", m.pillars, {.help = "Round pillars in the corridor", .min = 0, .max = 1000});
  field("people", m.people, {.help = "People walking in the corridor", .min = 0, .max = 1000});
  field("symmetric", m.symmetric, {.help = "The second half is the first one turned by half a turn"});
}

}  // namespace waymark::testbed
