// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/image_detector.hpp"

#include <algorithm>
#include <stdexcept>

namespace waymark::workflows {
namespace {

bool is_name(std::string_view name) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz";
  return !name.empty() && kLetters.find(name[0]) != std::string_view::npos &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}

bool has_record(const DetectionMethod& method) {
  return method.record == "image" || method.record == "heights";
}

}  // namespace

void ImageDetectorTable::add(ImageDetectorSpec detector) {
  if (!is_name(detector.name) || find(detector.name))
    throw std::logic_error("a detector in images needs a name of its own, is '" + detector.name + "'");
  if (detector.type.empty() || detector.methods.empty() || !detector.make ||
      !std::ranges::all_of(detector.methods, has_record))
    throw std::logic_error("detector " + detector.name + " declares no type, method, record or function");
  detectors_.push_back(std::move(detector));
}

const ImageDetectorSpec* ImageDetectorTable::find(std::string_view name) const {
  const auto found = std::ranges::find(detectors_, name, &ImageDetectorSpec::name);
  return found == detectors_.end() ? nullptr : &*found;
}

std::vector<std::string> ImageDetectorTable::names() const {
  std::vector<std::string> all;
  for (const ImageDetectorSpec& detector : detectors_) all.push_back(detector.name);
  return all;
}

std::vector<OptionRow> settings_of(const ImageDetectorSpec& detector) {
  const DescribeOptions describe = detector.make().describe;
  return describe ? option_table(describe) : std::vector<OptionRow>();
}

SettingUse use_of_setting(const ImageDetectorSpec& detector, std::string_view setting) {
  const auto use = std::ranges::find(detector.setting_use, setting, &SettingUse::name);
  return use == detector.setting_use.end() ? SettingUse{.name = std::string(setting)} : *use;
}

exporters::ImageDetections empty_detections(const DetectionPlan& plan) {
  const ImageInfo& info = plan.image->info();
  return {.type = plan.type,
          .image = info.name,
          .columns = info.columns,
          .rows = info.rows,
          .detections = {},
          .georeference = info.ortho,
          .gsd = plan.gsd,
          .sun_elevation = plan.sun_elevation,
          .sun_azimuth = plan.sun_azimuth};
}

}  // namespace waymark::workflows
