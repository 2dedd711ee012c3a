// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"
#include "localization/detectors/scan_landmarks.hpp"

namespace waymark::apps {
namespace {

class Detectors final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "detectors",
        .group = Group::look_up,
        .summary = "List the detectors of landmarks in scans, or describe one",
        .about =
            "A detector turns the scans of a log into sightings of landmarks. `localize` chooses them by "
            "the types of the landmarks in the map, or takes those of `--set scans=NAME,NAME`; `map` takes "
            "those of `--scans`. Detectors in images and elevation models are stages: `waymark stages`.",
        .arguments = reference_arguments(what_, localization::scan_detectors().names()),
        .examples = {{"waymark detectors walls", "The record it reads and the types it makes"},
                     {"waymark detectors --format json", "All of them for a script"}}};
  }

  int run(const Session&) override {
    print_reference(registry_reference(localization::scan_detectors()), "detector", what_);
    return 0;
  }

 private:
  ReferenceRequest what_;
};

}  // namespace

void register_command_detectors(CommandTable& commands);
void register_command_detectors(CommandTable& commands) {
  commands.add<Detectors>();
}

}  // namespace waymark::apps
