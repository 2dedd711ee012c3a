// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "core/options/option_table.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "landmarks/landmark_type.hpp"
#include "workflows/detection/detect.hpp"
#include "workflows/detection/search_image.hpp"
namespace waymark::workflows {

/// A checked request: the image, the sun's direction in it and what is asked. Input of a detector.
struct DetectionPlan {
  std::shared_ptr<const ImageSource> image;
  const TypeRegistry* types = nullptr;     ///< all types, those of plug-ins too
  TypeId type = 0;                         ///< of the detections
  std::string method = {};                 ///< empty: the detector chooses by the image
  std::optional<Degrees> image_sun_angle;  ///< towards the sun, from x towards y; nothing: to be estimated
  std::optional<Degrees> sun_elevation, sun_azimuth;
  std::optional<Meters> gsd;             ///< of an image without georeference
  ImageSearch search;                    ///< sizes in pixels, threads and progress
  std::optional<double> min_confidence;  ///< as asked; nothing: the detector's own
  std::vector<std::string> warnings;
};

/// Lowest confidence of detections unless the request or the detector says otherwise.
inline constexpr double kUsualConfidence = 0.5;

/// Returns a set of detections of the plan's type in its image that is still empty.
exporters::ImageDetections empty_detections(const DetectionPlan& plan);

/// A detector with its settings.
struct ImageDetector {
  DescribeOptions describe = {};  ///< settings beside those of all detectors; empty: none
  /// Reads what the settings name, before the image is opened. May be empty. Throws Error.
  std::function<void()> prepare = {};
  /// Searches the image. Throws Error for an image that it cannot use.
  std::function<DetectResult(const DetectionPlan& plan)> find;
};

/// A way to detect one kind of objects.
struct DetectionMethod {
  std::string name;
  std::string record = "image";  ///< what it reads: "image" (brightness, colours) or "heights" (metres above
                                 ///< ground)
  std::string remark = {};       ///< for the help, which puts it in brackets
};

/// How the command line shows a setting of a detector. Settings without one take any text.
struct SettingUse {
  std::string name;
  std::string value = "VALUE";            ///< placeholder
  std::vector<std::string> methods = {};  ///< that have it; empty: all
  bool is_file = false;                   ///< the shell offers files
};

/// Declaration of a detector in single images, a plug-in: `waymark detect NAME`. A new one is one new file in
/// workflows/detection/images.
struct ImageDetectorSpec {
  std::string name;                      ///< plural, lower case, underscores: "craters"
  std::string summary;                   ///< one line for the user
  std::string type;                      ///< landmark type that it makes
  std::vector<DetectionMethod> methods;  ///< the first is the default
  std::string method_by = {};            ///< how the detector chooses the method; empty: the first
  ImageSearch search = {};               ///< default sizes
  double smallest = 1;                   ///< px, lower bound of both sizes
  bool lists_sizes = true;               ///< whether the help shows the default sizes
  std::string max_diameter_text = {};    ///< of a largest size that depends on the image
  std::string confidence_text = {};      ///< of a lowest confidence that is not the usual one
  std::vector<SettingUse> setting_use = {};
  std::function<ImageDetector()> make;  ///< returns the detector with default settings
};

/// Registry of detectors in images, in order of registration.
class ImageDetectorTable {
 public:
  /// Throws std::logic_error for a name that is not [a-z][a-z0-9_]* or taken, and without type, methods or a
  /// function that makes it. So it does for a record that is neither "image" nor "heights".
  void add(ImageDetectorSpec detector);
  const ImageDetectorSpec* find(std::string_view name) const;
  std::vector<std::string> names() const;
  std::size_t size() const { return detectors_.size(); }
  auto begin() const { return detectors_.begin(); }
  auto end() const { return detectors_.end(); }

 private:
  std::deque<ImageDetectorSpec> detectors_;
};

/// Returns all detectors in images, those of plug-ins too.
const ImageDetectorTable& image_detectors();

/// Returns the settings of a detector with their defaults.
std::vector<OptionRow> settings_of(const ImageDetectorSpec& detector);

/// Returns how the command line shows a setting.
SettingUse use_of_setting(const ImageDetectorSpec& detector, std::string_view setting);

}  // namespace waymark::workflows
