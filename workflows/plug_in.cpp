// SPDX-License-Identifier: Apache-2.0
#include "workflows/plug_in.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "workflows/open_registries.hpp"

namespace waymark::workflows {
namespace {

using Register = void (*)(PlugIn&);
using Build = const char* (*)();

[[noreturn]] void refuse(const std::string& problem, const std::string& file, const std::string& hint) {
  throw Error(ErrorCode::input, problem, file, hint);
}

/// Returns the handle of a shared library, which is never closed: the program keeps what it registered.
void* open_library(const std::string& file) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown))
    refuse("there is no such plug-in", file, "give the shared library: --plugin build/my_plug_in.so");
  // With a slash: dlopen() searches the folders of the system for a bare name.
  void* const library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library)
    refuse(fmt::format("the plug-in cannot be loaded: {}", dlerror()), file,
           "build it as a shared library (CMake: add_library(... MODULE ...)) for this computer");
  return library;
}

template <class Function>
Function find_function(void* library, const char* name, const std::string& file) {
  void* const found = dlsym(library, name);
  if (!found)
    refuse(fmt::format("this is no plug-in of Waymark: it has no function {}", name), file,
           "include <waymark/plug_in.hpp> and define waymark_plug_in()");
  return reinterpret_cast<Function>(found);
}

void check_build(void* library, const std::string& file) {
  const std::string_view built = find_function<Build>(library, "waymark_plug_in_build", file)();
  if (built != plug_in_build())
    refuse(fmt::format("the plug-in was built for another Waymark: {}; this is {}", built, plug_in_build()),
           file, "build it again with the package of this program");
}

void check_types(const PlugIn& added) {
  const auto check = [&](const std::string& detector, const std::string& type) {
    if (!added.types.find(type))
      throw std::logic_error(
          fmt::format("detector {} makes the type '{}', which is not declared", detector, type));
  };
  for (const localization::DetectorSpec& one : added.scan_detectors)
    for (const std::string& type : one.types) check(one.name, type);
  for (const ImageDetectorSpec& one : added.image_detectors) check(one.name, one.type);
}

/// Returns the registries with what the plug-in adds to them; the stages are its own alone.
PlugIn registered(Register add) {
  PlugIn added{.types = open_types(),
               .stages = {},
               .scan_detectors = localization::scan_detectors(),
               .image_detectors = open_image_detectors()};
  add(added);
  check_types(added);
  return added;
}

/// Adds the entries of a registry beyond those that another one has.
template <class Registry, class Add>
void add_new(const Registry& from, std::size_t known, Add add) {
  std::for_each(from.begin() + static_cast<std::ptrdiff_t>(known), from.end(), add);
}

}  // namespace

void load_plug_in(const std::string& file) {
  static std::vector<void*> loaded;
  void* const library = open_library(file);
  if (std::ranges::count(loaded, library) > 0) return;
  check_build(library, file);
  const auto add = find_function<Register>(library, "waymark_plug_in", file);
  try {
    PlugIn added = registered(add);
    open_stages().take(std::move(added.stages));  // what may fail comes first
    add_new(added.types, open_types().size(), [](const LandmarkType& one) { open_types().add(one); });
    add_new(added.scan_detectors, localization::scan_detectors().size(), localization::add_scan_detector);
    add_new(added.image_detectors, open_image_detectors().size(),
            [](const ImageDetectorSpec& one) { open_image_detectors().add(one); });
  } catch (const std::exception& problem) {
    refuse(fmt::format("the plug-in cannot be registered: {}", problem.what()), file,
           "give its types, stages and detectors names of their own");
  }
  loaded.push_back(library);
}

}  // namespace waymark::workflows
