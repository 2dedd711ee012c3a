// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"
#include "workflows/registries.hpp"

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
            "`waymark query --sensor NAME` ranks landmarks by it.",
        .arguments = reference_arguments(what_, workflows::all_sensors().names()),
        .examples = {{"waymark sensors horizontal_laser", "What a horizontal laser makes of each feature"}}};
  }

  int run(const Session&) override {
    print_reference(registry_reference(workflows::all_sensors(), workflows::all_types()), "sensor", what_);
    return 0;
  }

 private:
  ReferenceRequest what_;
};

}  // namespace

void register_command_sensors(CommandTable& commands);
void register_command_sensors(CommandTable& commands) {
  commands.add<Sensors>();
}

}  // namespace waymark::apps
