// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/checked_alignment.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/association/outlying_images.hpp"
#include "pipeline/fusion/projection/dem_shift.hpp"
#include "pipeline/fusion/projection/dem_terrain.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"

namespace waymark::pipeline {
namespace {

struct AlignImages {
  struct Options {
    bool enabled = true;
    std::int64_t max_images = AlignmentRules{}.max_images;
    std::string wrong_geometry = "refuse";
    void describe(OptionVisitor& option) {
      option("enabled", enabled, {.help = "Correct poses; false leaves them as given"});
      option("max_images", max_images,
             {.help = "Most images that are aligned; the time grows with the third power",
              .min = 2,
              .max = 2000,
              .formerly = "most_images"});
      option("wrong_geometry", wrong_geometry,
             {.help = "What happens if objects of one image are hardly found again in others",
              .choices = {"refuse", "warn"}});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr Gather<ImageView> image_view{"image_view"};
  static constexpr In<std::vector<Observation>> cleaned{"cleaned"};
  static constexpr Out<std::vector<Observation>> observations{"observations"};
  static constexpr Out<std::vector<ImageView>> aligned_views{"aligned_views"};

  static StageSpec spec() {
    return {.name = "align_images",
            .summary = "Corrects the poses of images by the landmarks they share",
            .version = 10,
            .scope = Scope::map,
            .inputs = {dem, image_view, cleaned},
            .outputs = {observations, aligned_views}};
  }

  static std::string counted(const Repetition& seen) {
    return fmt::format(
        "{:.0f} % of {} views of an object are found again where another image shows the place "
        "({:.0f} % would be by chance)",
        100 * seen.raw, seen.expected, 100 * seen.chance);
  }

  // Standard deviations that poses get beyond those that they state.
  static std::string added(const CheckedAlignment& checked) {
    const std::string turn = fmt::format("{:.2g} deg", to_degrees(Radians{checked.added_rotation_sd}).value);
    if (!(checked.added_position_sd > 0)) return turn;
    return fmt::format("{:.2g} m", checked.added_position_sd) +
           (checked.added_rotation_sd > 0 ? " and " + turn : "");
  }

  // What the user can correct, with the fraction found again then.
  static std::string describe(const CommonGeometryError& cause) {
    const double percent = 100 * cause.found.raw;
    switch (cause.kind) {
      case CommonGeometryError::Kind::focal_length:
        return fmt::format("{:.0f} % are with focal lengths about {:.2f} times the given ones", percent,
                           1 / cause.amount);
      case CommonGeometryError::Kind::ground_height:
        return fmt::format("{:.0f} % are with a DEM about {:.2g} m {} or poses as much {}", percent,
                           std::abs(cause.amount), cause.amount > 0 ? "lower" : "higher",
                           cause.amount > 0 ? "higher" : "lower");
      case CommonGeometryError::Kind::transposed_rotations:
        break;
    }
    return fmt::format("{:.0f} % are with the rotations transposed", percent);
  }

  // What to check: the errors that would explain the images, or all that could.
  static std::string advice(const std::vector<CommonGeometryError>& causes) {
    if (causes.empty())
      return "check poses, focal length, rotation convention, and the heights and the position of the DEM";
    std::string text;
    for (const CommonGeometryError& cause : causes) text += (text.empty() ? "" : ", or ") + describe(cause);
    return text + ": correct the camera file or the DEM";
  }

  // Names the images that alone do not fit; empty if there are none.
  static std::string outliers(const Repetition& seen, const std::vector<ImageView>& images) {
    const OutlyingImages found = find_outlying_images(seen);
    if (found.images.empty()) return "";
    std::string names;
    for (const OutlyingImage& one : found.images)
      names += fmt::format("{}{} ({:.0f} % of {})", names.empty() ? "" : ", ", images[one.image].name,
                           100 * one.raw, one.expected);
    return fmt::format("; {} {} hardly any other image, {:.0f} % are without {}: check {}", names,
                       found.images.size() == 1 ? "fits" : "fit", 100 * found.rest,
                       found.images.size() == 1 ? "it" : "them",
                       found.images.size() == 1 ? "its pose" : "their poses");
  }

  // Reports what the comparison of the images says about their geometry.
  static void report(const CheckedAlignment& checked, const Options& options, StageContext& unit) {
    using Verdict = CheckedAlignment::Verdict;
    const std::string named =
        checked.causes.empty() ? outliers(checked.aligned, checked.alignment.images) : "";
    switch (checked.verdict) {
      case Verdict::unknown:
      case Verdict::sound:
        if (!checked.causes.empty())
          unit.warn(fmt::format("the images fit each other badly: {}; {}", counted(checked.stated),
                                advice(checked.causes)));
        else if (!named.empty())
          unit.warn(fmt::format("not all images fit each other: {}{}", counted(checked.aligned), named));
        return;
      case Verdict::widened:
        unit.warn(
            fmt::format("{}: {}; with {}{} {:.0f} % are{}",
                        checked.unstated ? "the camera file does not state how accurate all poses are"
                                         : "the poses are less certain than stated",
                        counted(checked.stated), added(checked),
                        checked.unstated ? " for what is not stated" : " added to their standard deviations",
                        100 * checked.aligned.raw,
                        checked.causes.empty() ? named : "; without that " + advice(checked.causes)));
        return;
      case Verdict::doubtful:
        unit.warn(fmt::format("the images hardly fit each other: {}{}", counted(checked.aligned),
                              named.empty() ? "; " + advice(checked.causes) : named));
        return;
      case Verdict::wrong:
        break;
    }
    const std::string problem =
        fmt::format("the images do not fit each other: {}{}",
                    counted(checked.causes.empty() ? checked.aligned : checked.stated), named);
    if (options.wrong_geometry == "refuse")
      throw Error(
          ErrorCode::input, problem, "images",
          fmt::format("{}; wrong_geometry = warn makes a map of it all the same", advice(checked.causes)));
    unit.warn(fmt::format("{}; {}", problem, advice(checked.causes)));
  }

  // Warns of poses without a stated uncertainty where the images have too little in common to show it.
  static void report_unstated(const std::vector<ImageView>& images, StageContext& unit) {
    const auto count = std::ranges::count_if(images, lacks_uncertainty);
    if (count > 0)
      unit.warn(fmt::format(
          "the poses of {} of {} images have no standard deviation, and the images have too few objects in "
          "common to show it: the covariances of the map lack the errors of the poses; give position_sd and "
          "rotation_sd",
          count, images.size()));
  }

  // Warns where the relief in the images lies beside that of the DEM. Positions become uncertain by as much,
  // since images and DEM do not determine which of them is right.
  static void report_dem_shift(std::vector<ImageView>& images, StageContext& unit) {
    const auto seen = common_dem_shift(images);
    if (!seen || !seen->significant) return;
    unit.warn(fmt::format(
        "images and DEM do not lie on each other: in {} of {} images the relief is {:.2g} m (sd {:.2g} m) "
        "from "
        "that of the DEM, {:+.2g} m east and {:+.2g} m north, where the poses state {:.2g} m; check the "
        "positions of poses and DEM (datum, projection, corner or centre of cells)",
        seen->measured, images.size(), seen->metres.norm(), seen->sd, seen->metres.x(), seen->metres.y(),
        seen->stated_sd));
    for (ImageView& image : images)
      image.common_covariance +=
          seen->metres * seen->metres.transpose() + seen->sd * seen->sd * Eigen::Matrix2d::Identity();
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<ImageView> images;
    for (const auto& image : unit.read_all(image_view)) images.push_back(*image);
    const DemHandle& ground = unit.read(dem);
    Alignment aligned{unit.read(cleaned), std::move(images), {}, 0, false};
    if (options.enabled) {
      CheckedAlignmentRules rules;
      rules.alignment.max_images = static_cast<int>(options.max_images);
      CheckedAlignment checked = align_and_check(aligned.observations, aligned.images, load_terrain(ground),
                                                 types, ground->geometry().where.crs, rules);
      report(checked, options, unit);
      if (checked.verdict == CheckedAlignment::Verdict::unknown) report_unstated(aligned.images, unit);
      aligned = std::move(checked.alignment);
    }
    if (aligned.too_many)
      unit.warn(fmt::format("{} images are not aligned: max_images allows {}", aligned.images.size(),
                            options.max_images));
    report_dem_shift(aligned.images, unit);
    unit.write(observations, std::move(aligned.observations));
    unit.write(aligned_views, std::move(aligned.images));
  }
};

}  // namespace

void register_stage_align_images(Registry& registry);
void register_stage_align_images(Registry& registry) {
  registry.add<AlignImages>();
}

}  // namespace waymark::pipeline
