// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.hpp"
#include "importers/tiling.hpp"
#include "pipeline/forest/crown_network.hpp"
#include "pipeline/forest/tree_ground.hpp"
#include "pipeline/forest/tree_observations.hpp"
#include "pipeline/vision/real_fraction.hpp"
#include "workflows/detection/crown_detection.hpp"
#include "workflows/detection/image_canopy.hpp"
#include "workflows/detection/image_detector.hpp"
#include "workflows/detection/search_image.hpp"

namespace waymark::workflows {
namespace {

constexpr double kUsualPixel = 0.6;  // metres: of public orthophotos
constexpr double kMinGreenness = 0.2;
/// Finer colour images without infrared are searched by darkness: the networks are trained on pixels of 0.6
/// m, and trees look different in pixels of 0.1 m.
constexpr double kFinePixel = 0.25;
constexpr double kPositionSd = 1.5;  // metres, of marked trees about detections
constexpr double kCrownError = 0.4;  // fraction of a crown's diameter in colour images

// For fine colour images without infrared (docs/methods/trees.md).
pipeline::TreeSearch imagery_search() {
  pipeline::TreeSearch search;
  search.forest.name = "imagery";
  search.forest.smoothing = 0.9;
  search.forest.tops = {
      .min_height = kMinGreenness, .isolation_base = 3, .isolation_slope = 0, .prominence = 0};
  search.forest.crowns = {.floor = 0.6 * kMinGreenness,
                          .min_height_fraction = 0.5,
                          .radius_base = 6,
                          .radius_slope = 0,
                          .max_radius = 6};
  return search;
}

pipeline::TreeSearch height_search(const std::string& method) {
  pipeline::TreeSearch search;
  if (method == "lmf") search.forest = pipeline::local_maxima_preset(search.forest);
  return search;
}

double pixel_metres(const DetectionPlan& plan, DetectResult& found) {
  const ImageInfo& info = plan.image->info();
  if (info.ortho)
    return std::sqrt(-info.ortho->dx * info.ortho->dy) *
           (info.ortho->crs.kind() == CrsKind::local ? 1 : info.ortho->crs.metres_per_unit());
  if (plan.gsd) return plan.gsd->value;
  for (const std::string& warning : plan.warnings)
    if (warning.starts_with("its georeference is not used"))
      throw Error(ErrorCode::input,
                  "the size of a pixel in metres is not known, and trees are found by metres", info.path,
                  "reproject it into metres (gdalwarp -t_srs EPSG:...), or pass --gsd");
  found.warnings.push_back(
      fmt::format("the size of a pixel is not known and taken as {:g} m: pass --gsd", kUsualPixel));
  return kUsualPixel;
}

std::vector<pipeline::DetectedTree> search_tiles(const CanopySource& canopy,
                                                 const pipeline::TreeSearch& search, const ImageSearch& how) {
  const GridGeometry& grid = canopy.geometry();
  const std::vector<pipeline::Tile> tiles =
      importers::tiles_of(grid.columns, grid.rows, std::min<std::int64_t>(how.piece, 2048));
  std::vector<std::vector<pipeline::DetectedTree>> parts(tiles.size());
  pipeline::ProgressMeter meter(how.progress, "search_image", static_cast<std::int64_t>(tiles.size()));
  tbb::task_arena arena(how.threads > 0 ? how.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
      parts[i] = pipeline::find_trees(canopy, tiles[i].cells, search);
      meter.add(1);
    });
  });
  meter.finish();
  std::vector<pipeline::DetectedTree> all;
  for (auto& part : parts)
    all.insert(all.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
  return all;
}

Detection detection_of(const pipeline::DetectedTree& tree, TypeId type, double metres, bool imagery) {
  Detection one;
  one.type = type;
  const double diameter = std::max(tree.crown_diameter / metres, 1.0);
  one.outline = {static_cast<double>(tree.top.column), static_cast<double>(tree.top.row), diameter, diameter,
                 0};
  const pipeline::TreeErrors errors;
  const double sd = imagery ? kPositionSd : errors.position_base + errors.position_slope * tree.height;
  one.covariance = Eigen::Matrix2d::Identity() * (sd * sd / (metres * metres) + 1.0 / 12);
  one.diameter_sd = errors.crown_relative * diameter;
  one.confidence = imagery ? 1 - 0.5 * std::exp(1 - tree.height / kMinGreenness) : tree.confidence;
  return one;
}

struct TreeCandidate {
  Detection detection;
  FeatureSet features;
  bool doubtful = true;  ///< its confidence is lowered where the ground is none that trees stand on
};

/// Lowers the confidences of the doubtful trees, so that their sum is `fraction` of what it was.
void lower_doubtful(std::vector<TreeCandidate>& trees, double fraction) {
  std::vector<double> confidences;
  for (const TreeCandidate& one : trees)
    if (one.doubtful) confidences.push_back(one.detection.confidence);
  pipeline::lower_to_fraction(confidences, fraction);
  std::size_t next = 0;
  for (TreeCandidate& one : trees)
    if (one.doubtful) one.detection.confidence = confidences[next++];
}

/// Finds tops of a canopy: of heights, or of greenness and darkness in a colour image. Warns of a band that
/// holds no heights, and lowers the confidences then.
std::vector<TreeCandidate> detect_by_canopy(const DetectionPlan& plan, double metres,
                                            const std::string& method, std::vector<std::string>& warnings) {
  const bool imagery = method == "imagery";
  const LandmarkType& tree_type = (*plan.types)[plan.type];
  const auto canopy =
      image_canopy(plan.image->info(), imagery ? CanopySign::greenness : CanopySign::height, metres);
  const pipeline::TreeSearch search = imagery ? imagery_search() : height_search(method);
  std::vector<TreeCandidate> kept;
  pipeline::TreeShapes shapes;
  for (const pipeline::DetectedTree& tree : search_tiles(*canopy, search, plan.search)) {
    if (!imagery) shapes.add(tree.height, tree.crown_diameter);
    TreeCandidate one{detection_of(tree, plan.type, metres, imagery), {}};
    one.features =
        pipeline::observation_of(tree, *canopy, tree_type, plan.type, pipeline::built_in_allometry(), "mixed",
                                 pipeline::tree_errors("mixed", true))
            .features;
    if (imagery)
      one.features[feature_index(tree_type, "height")] =
          one.features[feature_index(tree_type, "diameter")] = {};
    kept.push_back(std::move(one));
  }
  if (shapes.real_fraction() < 1) {
    warnings.push_back(pipeline::tree_shapes_warning(shapes));
    lower_doubtful(kept, shapes.real_fraction());
  }
  return kept;
}

/// Finds crowns of a colour image with a trained network. Warns of an image without vegetation, and lowers
/// the confidences of crowns that are not green then.
std::vector<TreeCandidate> detect_by_network(const DetectionPlan& plan, double metres,
                                             std::vector<std::string>& warnings) {
  const ColourImage image(plan.image->info(), metres);
  const LandmarkType& tree_type = (*plan.types)[plan.type];
  const pipeline::DenseNetwork& network =
      image.infrared() ? pipeline::crown_network_infrared() : pipeline::crown_network_colour();
  std::vector<TreeCandidate> kept;
  pipeline::CrownColours colours;
  for (const DetectedCrown& crown :
       detect_crowns(image, network, plan.search.threads, plan.search.progress)) {
    TreeCandidate one;
    one.doubtful = !crown.green;
    if (crown.confidence >= kUsualConfidence) ++(crown.green ? colours.green : colours.other);
    one.detection.type = plan.type;
    const double diameter = crown.diameter / metres;
    one.detection.outline = {crown.x, crown.y, diameter, diameter, 0};
    one.detection.covariance = Eigen::Matrix2d::Identity() * std::pow(kPositionSd / metres, 2);
    one.detection.diameter_sd = kCrownError * diameter;
    one.detection.confidence = crown.confidence;
    one.features.resize(tree_type.features.size());
    one.features[feature_index(tree_type, "crown_diameter")] = {crown.diameter,
                                                                std::pow(kCrownError * crown.diameter, 2), 1};
    kept.push_back(std::move(one));
  }
  if (colours.real_fraction_of_other() < 1) {
    warnings.push_back(pipeline::crown_colours_warning(colours));
    lower_doubtful(kept, colours.real_fraction_of_other());
  }
  return kept;
}

// A tower or an outlier may stand above the trees.
constexpr double kFarAboveTrees = 5;

/// Warns if the pixels of a band without trees are too high or too low for heights above ground.
void check_heights(const ImageSource& image, std::vector<std::string>& warnings) {
  const Brightness seen = measure_brightness(image);
  if (seen.no_data == seen.pixels) {
    warnings.push_back("the image has no data");
  } else if (static_cast<double>(seen.darkest) > pipeline::kTallestTree ||
             static_cast<double>(seen.brightest) > kFarAboveTrees * pipeline::kTallestTree ||
             static_cast<double>(seen.brightest) < pipeline::TreeSearch{}.forest.tops.min_height) {
    warnings.push_back(fmt::format(
        "its values are {:g} to {:g}, but heights of trees above ground are {:g} to {:g} m", seen.darkest,
        seen.brightest, pipeline::TreeSearch{}.forest.tops.min_height, pipeline::kTallestTree));
  }
}

/// Method `imagery` finds crowns in colour images with a trained network, or as dark green blobs in images
/// finer than 0.25 m without infrared. `peaks` and `lmf` find treetops in a single band of heights above
/// ground. Throws Error{input} for an image in degrees, Error{usage} for a method that does not fit the
/// image's bands.
DetectResult detect_trees(const DetectionPlan& plan) {
  const ImageInfo& info = plan.image->info();
  const int bands = band_count(info.path);
  const std::string method = !plan.method.empty() ? plan.method : bands >= 3 ? "imagery" : "peaks";
  const bool imagery = method == "imagery";
  if (imagery && bands < 3)
    throw Error(ErrorCode::usage,
                fmt::format("--method imagery needs a colour image; this one has {} band{}", bands,
                            bands == 1 ? "" : "s"),
                info.path, "heights above ground are searched with --method peaks or lmf");
  if (!imagery && bands > 2)
    throw Error(ErrorCode::usage,
                fmt::format("--method {} needs one band of heights; this image has {}", method, bands),
                info.path, "colour images are searched with --method imagery");
  DetectResult found;
  const double metres = pixel_metres(plan, found);
  found.detections = empty_detections(plan);
  std::vector<TreeCandidate> kept = imagery && (bands > 3 || metres >= kFinePixel)
                                        ? detect_by_network(plan, metres, found.warnings)
                                        : detect_by_canopy(plan, metres, method, found.warnings);
  if (!imagery && kept.empty()) check_heights(*plan.image, found.warnings);
  const double min_confidence = plan.min_confidence.value_or(imagery ? kUsualConfidence : 0);
  std::erase_if(kept, [&](const TreeCandidate& one) {
    const double diameter = one.detection.outline.diameter();
    return one.detection.confidence < min_confidence || diameter < plan.search.min_diameter ||
           (plan.search.max_diameter > 0 && diameter > plan.search.max_diameter);
  });
  std::stable_sort(kept.begin(), kept.end(), [](const TreeCandidate& a, const TreeCandidate& b) {
    const auto key = [](const Detection& d) { return std::tuple(-d.confidence, d.outline.y, d.outline.x); };
    return key(a.detection) < key(b.detection);
  });
  for (TreeCandidate& one : kept) {
    found.detections.detections.push_back(one.detection);
    found.detections.features.push_back(std::move(one.features));
  }
  return found;
}

}  // namespace

void register_image_trees(ImageDetectorTable& detectors);
void register_image_trees(ImageDetectorTable& detectors) {
  detectors.add({.name = "trees",
                 .summary = "Trees, by their crowns in colours or in heights above ground",
                 .type = "tree",
                 .methods = {{.name = "imagery", .remark = "colour"},
                             {.name = "peaks", .record = "heights"},
                             {.name = "lmf", .record = "heights", .remark = "heights above ground"}},
                 .method_by = "by the bands of the image",
                 .search = {.min_diameter = 1, .reduce_for_large = false},
                 .smallest = 0.1,
                 .lists_sizes = false,
                 .confidence_text = "nothing of trees found by heights",
                 .make = [] { return ImageDetector{.find = detect_trees}; }});
}

}  // namespace waymark::workflows
