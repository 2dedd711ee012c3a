// SPDX-License-Identifier: Apache-2.0
#include "workflows/registries.hpp"

#include "importers/stages.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/stages.hpp"
#include "workflows/open_registries.hpp"

namespace waymark::workflows {

void register_built_in_stages(pipeline::Registry& registry) {
  importers::register_importer_stages(registry);
  pipeline::register_pipeline_stages(registry);
}

pipeline::Registry& open_stages() {
  static pipeline::Registry registry = [] {
    pipeline::Registry made;
    register_built_in_stages(made);
    return made;
  }();
  return registry;
}

const pipeline::Registry& all_stages() {
  return open_stages();
}

ImageDetectorTable& open_image_detectors() {
  static ImageDetectorTable table = [] {
    ImageDetectorTable made;
    register_image_detectors(made);
    return made;
  }();
  return table;
}

const ImageDetectorTable& image_detectors() {
  return open_image_detectors();
}

}  // namespace waymark::workflows
