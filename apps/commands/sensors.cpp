// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <set>

#include "apps/log.hpp"
#include "apps/registry_reference.hpp"
#include "core/error.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::apps {
namespace {

class Sensors final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "sensors",
        .group = Group::look_up,
        .summary = "List the sensor profiles, or describe one with its weights",
        .about =
            "A sensor profile says how much each feature helps that sensor to distinguish landmarks. "
            "`waymark query --sensor NAME` ranks landmarks by it. `--format json` prints a file to copy and "
            "change; every --sensor also takes such a FILE.json, and `waymark sensors FILE.json` checks it.",
        .arguments = reference_arguments(what_, workflows::all_sensors().names()),
        .examples = {{"waymark sensors horizontal_laser", "Weights and coverage of a horizontal laser"},
                     {"waymark sensors horizontal_laser --format json > mine.json", "A file to change"}}};
  }

  int run(const Session&) override {
    SensorRegistry sensors;
    if (what_.name.ends_with(".json")) {  // checks a file, and prints what was read
      SensorProfile own = *workflows::find_sensor(what_.name);
      own.name = what_.name;
      warn_of_unknown_types(own);
      sensors.add(std::move(own));
    } else {
      for (const SensorProfile& sensor : workflows::all_sensors()) sensors.add(sensor);
    }
    print_reference(registry_reference(sensors, workflows::all_types()), "sensor", what_);
    return 0;
  }

 private:
  static void warn_of_unknown_types(const SensorProfile& sensor) {
    std::set<std::string> seen;
    for (const FeatureWeight& feature : sensor.weights) {
      if (workflows::all_types().find(feature.type) || !seen.insert(feature.type).second) continue;
      const std::string nearest = nearest_name(feature.type, workflows::all_types().names());
      log_warning(
          fmt::format("no landmark type of this program is named '{}'{}: its weights apply to maps with "
                      "such a type only",
                      feature.type, nearest.empty() ? "" : fmt::format("; '{}' is", nearest)));
    }
  }

  ReferenceRequest what_;
};

}  // namespace

void register_command_sensors(CommandTable& commands);
void register_command_sensors(CommandTable& commands) {
  commands.add<Sensors>();
}

}  // namespace waymark::apps
