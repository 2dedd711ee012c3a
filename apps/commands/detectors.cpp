// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "workflows/detection/image_detector.hpp"

namespace waymark::apps {
namespace {

std::vector<ReferenceEntry> all_detectors() {
  std::vector<ReferenceEntry> all = registry_reference(localization::scan_detectors());
  for (ReferenceEntry& one : registry_reference(workflows::image_detectors())) all.push_back(std::move(one));
  return all;
}

std::vector<std::string> names_of(const std::vector<ReferenceEntry>& entries) {
  std::vector<std::string> names;
  for (const ReferenceEntry& one : entries) names.push_back(one.name);
  return names;
}

class Detectors final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "detectors",
        .group = Group::look_up,
        .summary = "List the detectors of landmarks in scans and single images, or describe one",
        .about =
            "A detector turns the scans of a log into sightings of landmarks. `localize` chooses them by "
            "the types of the landmarks in the map, or takes those of `--set scans=NAME,NAME`; `map` takes "
            "those of `--scans`. Detectors in single images are named image_NAME here; `waymark detect NAME` "
            "runs them. Detectors in images with poses and in elevation models are stages: `waymark stages`.",
        .arguments = reference_arguments(what_, names_of(all_detectors())),
        .examples = {{"waymark detectors walls", "The record it reads and the types it makes"},
                     {"waymark detectors image_trees", "What `waymark detect trees` reads, and its methods"},
                     {"waymark detectors --format json", "All of them for a script"}}};
  }

  int run(const Session&) override {
    if (!what_.name.empty() || what_.format != "text") {
      print_reference(all_detectors(), "detector", what_);
    } else {  // two lists, each with its own width
      print_reference(registry_reference(localization::scan_detectors()), "detector", what_);
      print_reference(registry_reference(workflows::image_detectors()), "detector", what_);
    }
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
