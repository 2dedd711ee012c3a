// SPDX-License-Identifier: Apache-2.0
#include "workflows/registries.hpp"

#include "importers/stages.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/stages.hpp"

namespace waymark::workflows {

void register_built_in_stages(pipeline::Registry& registry) {
  importers::register_importer_stages(registry);
  pipeline::register_pipeline_stages(registry);
}

const pipeline::Registry& all_stages() {
  static const pipeline::Registry registry = [] {
    pipeline::Registry made;
    register_built_in_stages(made);
    return made;
  }();
  return registry;
}

}  // namespace waymark::workflows
