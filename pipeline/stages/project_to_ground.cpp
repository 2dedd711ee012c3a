// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "geo/image_source.hpp"
#include "geo/plane_dem.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/cleaning/rim_evidence.hpp"
#include "pipeline/fusion/projection/dem_registration.hpp"
#include "pipeline/fusion/projection/dem_shift.hpp"
#include "pipeline/fusion/projection/dem_terrain.hpp"
#include "pipeline/fusion/projection/detection_projection.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"
#include "pipeline/fusion/projection/image_view_factory.hpp"

namespace waymark::pipeline {
namespace {

struct ProjectToGround {
  struct Options {
    Meters height_sd{0};
    ProjectionRules rules = {};
    double min_crater_confidence = 0.5;
    bool register_to_dem = true;
    void describe(OptionVisitor& option) {
      option(
          "height_sd", height_sd,
          {.help =
               "Standard deviation of heights of a DEM without its own; lowers the accuracy of positions in "
               "oblique views",
           .min = 0,
           .max = 1000});
      option("slope_sd", rules.slope_sd,
             {.help = "Standard deviation of the slope under a rock relative to the DEM, metres per metre",
              .min = 0,
              .max = 1});
      option(
          "outline_edge_fraction", rules.outline_edge_fraction,
          {.help =
               "Position of a crater's outline between crest (0) and visible edge (1), by which outlines are "
               "widened to the crest where the DEM resolves the crater",
           .min = 0,
           .max = 1,
           .formerly = "edge_share"});
      option("shadow_shape", rules.shadow_shape,
             {.help = "Standard deviation of a rock's centre along the sun due to its shape, in diameters",
              .min = 0,
              .max = 1});
      option("rim_shape", rules.rim_shape,
             {.help = "Standard deviation of a crater's centre due to its uneven rim, in diameters",
              .min = 0,
              .max = 1});
      option("min_crater_confidence", min_crater_confidence,
             {.help = "Smallest probability of a crater that is kept, by image and DEM together",
              .min = 0,
              .max = 1,
              .formerly = "least_crater"});
      option("register_to_dem", register_to_dem,
             {.help = "Register the image to the DEM by its shading, which corrects its pose in align_images",
              .formerly = "match_ground"});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<ImageSet> image_set{"image_set"};
  static constexpr Gather<std::vector<Detection>> detections{"detections"};
  static constexpr Out<std::vector<Observation>> placed_observations{"placed"};
  static constexpr Out<ImageView> image_view{"image_view"};

  static StageSpec spec() {
    return {.name = "project_to_ground",
            .summary = "Projects detections onto the DEM, with covariances and footprints",
            .version = 13,
            .scope = Scope::image,
            .inputs = {dem, image_set, detections},
            .outputs = {placed_observations, image_view}};
  }

  static void check_inputs(const Options&, StageContext& unit) {
    if (unit.has(dem)) check_metric(*unit.read(dem));
  }

  static void run(const Options& options, StageContext& unit) {
    const DemHandle& ground = unit.read(dem);
    const ImageInfo& info = unit.read(image_set).at(static_cast<std::size_t>(unit.image().index))->info();
    ImageView image = make_image_view(info);
    if (!info.crs.same_as(ground->geometry().where.crs))
      throw Error(ErrorCode::input,
                  fmt::format("image '{}' is in {}, the DEM in {}", info.name, info.crs.id(),
                              ground->geometry().where.crs.id()),
                  info.path, "give load_images the DEM's CRS, or warp the DEM or the orthophoto");
    const Terrain terrain = load_terrain(ground);
    const double metres_per_unit = info.crs.metres_per_unit();
    compute_footprint(image, terrain, metres_per_unit);
    if (image.footprint.empty()) unit.warn(why_no_ground(image, terrain));

    const TypeRegistry& types = unit.types();
    ProjectionRules rules = options.rules;
    rules.height_sd = options.height_sd.value;
    rules.heights_known = !is_assumed_plane(*ground);
    std::vector<Observation> all;
    for (const auto& found : unit.read_all(detections))
      for (const Detection& detection : *found) {
        unit.count_in(1);
        all.push_back(project_detection(detection, image, terrain, types[detection.type], rules));
        all.back().position.xyz.head<2>() /= metres_per_unit;
      }
    std::erase_if(all, [&](const Observation& o) {  // no position on the map
      if (!o.rejected.empty()) unit.reject(o.rejected);
      return !o.rejected.empty();
    });
    if (rules.heights_known) update_crater_confidences(all, types, terrain, metres_per_unit);
    std::int64_t kept = 0;
    for (Observation& o : all) {
      if (types[o.type].evidence == EvidenceModel::bowl && o.confidence < options.min_crater_confidence)
        o.rejected = "more probably no crater";
      o.rejected.empty() ? void(++kept) : unit.reject(o.rejected);
    }
    if (options.register_to_dem && rules.heights_known && image.view && image.sun) {
      const Pixels pixels = unit.read(image_set)
                                .at(static_cast<std::size_t>(unit.image().index))
                                ->read({0, 0, info.columns, info.rows});
      image.dem_constraint = register_to_dem(pixels, image, terrain, metres_per_unit);
      image.dem_shift = measure_dem_shift(pixels, image, terrain, metres_per_unit);
    }
    unit.count_in(0), unit.count_out(kept);
    unit.write(placed_observations, std::move(all));
    unit.write(image_view, std::move(image));
  }

  static std::string why_no_ground(const ImageView& image, const Terrain& terrain) {
    std::string text = "the image shows no ground of the DEM";
    if (!image.view) return text + ": they do not overlap";
    const auto line = viewing_ray(
        image, {static_cast<double>(image.columns - 1) / 2, static_cast<double>(image.rows - 1) / 2});
    if (!line) return text + ": its centre is outside the lens model";
    const auto below = terrain.height(line->origin.xyz.x(), line->origin.xyz.y());
    if (below && *below > line->origin.xyz.z())
      return text + fmt::format(
                        ": the camera is {:.4g} m under the ground; a vertical datum (geoid, areoid) "
                        "may be missing",
                        *below - line->origin.xyz.z());
    if (line->direction.unit.z() >= 0) return text + ": the camera looks at the sky";
    return text + fmt::format(": from {:.1f}, {:.1f} its view misses the DEM's extent", line->origin.xyz.x(),
                              line->origin.xyz.y());
  }
};

}  // namespace

void register_stage_project_to_ground(Registry& registry);
void register_stage_project_to_ground(Registry& registry) {
  registry.add<ProjectToGround>();
}

}  // namespace waymark::pipeline
