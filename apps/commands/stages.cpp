// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"
#include "pipeline/engine/registry.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class Stages final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "stages",
            .group = Group::look_up,
            .summary = "List the stages a job can name, or describe one with all its options",
            .arguments = reference_arguments(what_, workflows::all_stages().names()),
            .examples = {
                {"waymark stages find_mountain_tops", "Its options with units, ranges and defaults"},
                {"waymark stages load_dem --format schema", "The JSON schema of this stage in a job file"}}};
  }

  int run(const Session&) override {
    print_reference(registry_reference(workflows::all_stages()), "stage", what_);
    return 0;
  }

 private:
  ReferenceRequest what_;
};

}  // namespace

void register_command_stages(CommandTable& commands);
void register_command_stages(CommandTable& commands) {
  commands.add<Stages>();
}

}  // namespace waymark::apps
