// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

class Types final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "types",
            .group = Group::look_up,
            .summary = "List the landmark types, or describe one with its features",
            .arguments = reference_arguments(what_, workflows::all_types().names()),
            .examples = {{"waymark types mountain_top", "Its features with units and plausible ranges"},
                         {"waymark types rock --format json", "The same for a script"}}};
  }

  int run(const Session&) override {
    print_reference(registry_reference(workflows::all_types()), "landmark type", what_);
    return 0;
  }

 private:
  ReferenceRequest what_;
};

}  // namespace

void register_command_types(CommandTable& commands);
void register_command_types(CommandTable& commands) {
  commands.add<Types>();
}

}  // namespace waymark::apps
