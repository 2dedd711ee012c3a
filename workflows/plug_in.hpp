// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "landmarks/landmark_type.hpp"
#include "localization/detectors/detector_table.hpp"
#include "pipeline/engine/registry.hpp"
#include "workflows/detection/image_detector.hpp"
namespace waymark::workflows {

/// What a plug-in, a shared library, adds to. A name may be used once.
struct PlugIn {
  TypeRegistry types;  ///< holds the built-in types
  pipeline::Registry stages;
  localization::DetectorTable scan_detectors;
  ImageDetectorTable image_detectors;
};

/// Returns version, compiler and layout of the values that plug-ins exchange with a program. A plug-in fits a
/// program if both have the same.
const char* plug_in_build();

/// Loads a plug-in, so that commands know its types, stages and detectors as their own. It stays loaded, and
/// a second call has no effect. Call it before other threads use the library. Throws Error{input}, and adds
/// nothing, for
/// - a file that is no plug-in, or was built for another program;
/// - a name that is taken, and a detector of a type that is not declared.
void load_plug_in(const std::string& file);

}  // namespace waymark::workflows

extern "C" {

/// A plug-in defines this function, which adds what it has. It runs once, before any work.
[[gnu::visibility("default")]] void waymark_plug_in(waymark::workflows::PlugIn& to);

/// Lets load_plug_in() compare the program with the library that a plug-in is linked with.
[[gnu::visibility("default"), gnu::used]] inline const char* waymark_plug_in_build() {
  return waymark::workflows::plug_in_build();
}

}  // extern "C"
