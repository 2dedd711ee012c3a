// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"
#include "planning/vehicle.hpp"

namespace waymark::apps {
namespace {

class Vehicles final : public Command {
 public:
  CommandSpec describe() override {
    std::vector<std::string> names;
    for (const planning::VehicleFile& file : planning::vehicle_files()) names.emplace_back(file.name);
    return {
        .name = "vehicles",
        .group = Group::look_up,
        .summary = "List the vehicles, or describe one with its limits",
        .about =
            "A vehicle file gives the positions of wheels or feet and the relief that they allow. "
            "`--format json` prints a file to copy and change; `waymark hazards --vehicle FILE` reads it.",
        .arguments = reference_arguments(what_, names),
        .examples = {{"waymark vehicles rover --format json > mine.json", "A file to change"}}};
  }

  int run(const Session&) override {
    print_reference(vehicle_reference(), "vehicle", what_);
    return 0;
  }

 private:
  ReferenceRequest what_;
};

}  // namespace

void register_command_vehicles(CommandTable& commands);
void register_command_vehicles(CommandTable& commands) {
  commands.add<Vehicles>();
}

}  // namespace waymark::apps
