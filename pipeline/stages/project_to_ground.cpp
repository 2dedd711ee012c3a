// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "geo/image_source.hpp"
#include "geo/plane_dem.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/closed_rims.hpp"
#include "pipeline/fusion/detection_codec.hpp"
#include "pipeline/fusion/ground_match.hpp"
#include "pipeline/fusion/image_view_codec.hpp"
#include "pipeline/fusion/image_view_of.hpp"
#include "pipeline/fusion/placing.hpp"
#include "pipeline/fusion/terrain_of.hpp"

namespace waymark {
namespace {

struct ProjectToGround {
  struct Options {
    Meters height_sd{0};
    double slope_sd = PlacingRules{}.slope_sd;
    double edge_share = PlacingRules{}.edge_share;
    double shadow_shape = PlacingRules{}.shadow_shape;
    double rim_shape = PlacingRules{}.rim_shape;
    double least_crater = 0.5;
    bool match_ground = true;
    void describe(OptionVisitor& option) {
      option("height_sd", height_sd,
             {.help = "Standard deviation of the ground's height where the DEM does not tell its own: places "
                      "seen from the side become less certain",
              .min = 0,
              .max = 1000});
      option("slope_sd", slope_sd,
             {.help = "Standard deviation of the slope under a rock against the DEM's, metres per metre",
              .min = 0,
              .max = 1});
      option(
          "edge_share", edge_share,
          {.help = "How far from its crest towards its visible edge a crater's outline lies; where the DEM "
                   "shows how worn it is, it is made as wide as its crest: 0 for detectors that tell crests",
           .min = 0,
           .max = 1});
      option("shadow_shape", shadow_shape,
             {.help = "Uncertainty of a rock's middle along the sun, from its unknown shape, in diameters",
              .min = 0,
              .max = 1});
      option("rim_shape", rim_shape,
             {.help = "Uncertainty of a crater's middle from the unevenness of its rim, in diameters",
              .min = 0,
              .max = 1});
      option("least_crater", least_crater,
             {.help = "Craters less probable than this, by image and DEM together, are rejected",
              .min = 0,
              .max = 1});
      option("match_ground", match_ground,
             {.help =
                  "Compares the image with the light the DEM's slopes would show, to tell align_images where "
                  "the pose is off"});
    }
  };
  static constexpr In<DemHandle> dem{"dem"};
  static constexpr In<ImageSet> image_set{"image_set"};
  static constexpr Gather<std::vector<Detection>> detections{"detections"};
  static constexpr Out<std::vector<Observation>> placed_observations{"placed"};
  static constexpr Out<ImageView> image_view{"image_view"};

  static StageSpec spec() {
    return {.name = "project_to_ground",
            .summary = "Places detections on the DEM through the camera, with covariance; footprints",
            .version = 9,
            .scope = Scope::image,
            .inputs = {dem, image_set, detections},
            .outputs = {placed_observations, image_view}};
  }

  static void run(const Options& options, StageContext& unit) {
    const DemHandle& ground = unit.read(dem);
    const ImageInfo& info = unit.read(image_set).at(static_cast<std::size_t>(unit.image().index))->info();
    ImageView image = image_view_of(info);
    if (!info.crs.same_as(ground->geometry().where.crs))
      throw Error(ErrorCode::input,
                  fmt::format("image '{}' is in {}, the DEM in {}", info.name, info.crs.id(),
                              ground->geometry().where.crs.id()),
                  info.path, "give load_images the DEM's CRS, or warp the DEM or the orthophoto");
    const Terrain terrain = terrain_of(ground);
    const double metres_per_unit = info.crs.metres_per_unit();
    lay_out(image, terrain, metres_per_unit);
    if (image.footprint.empty()) unit.warn(why_no_ground(image, terrain));

    TypeRegistry types;
    register_landmark_types(types);
    const PlacingRules rules{.height_sd = options.height_sd.value,
                             .heights_known = !is_assumed_plane(*ground),
                             .slope_sd = options.slope_sd,
                             .edge_share = options.edge_share,
                             .shadow_shape = options.shadow_shape,
                             .rim_shape = options.rim_shape};
    std::vector<Observation> all;
    for (const auto& found : unit.read_all(detections))
      for (const Detection& detection : *found) {
        unit.count_in(1);
        all.push_back(placed(detection, image, terrain, types[detection.type], rules));
        all.back().position.xyz.head<2>() /= metres_per_unit;
      }
    std::erase_if(all, [&](const Observation& o) {  // no place on the map
      if (!o.rejected.empty()) unit.reject(o.rejected);
      return !o.rejected.empty();
    });
    if (rules.heights_known) weigh_by_rims(all, types, terrain, metres_per_unit);
    std::int64_t kept = 0;
    for (Observation& o : all) {
      if (types[o.type].drawn_as == Solid::bowl && o.confidence < options.least_crater)
        o.rejected = "more probably no crater";
      o.rejected.empty() ? void(++kept) : unit.reject(o.rejected);
    }
    if (options.match_ground && rules.heights_known && image.view && image.view->covariance.trace() > 0) {
      const Pixels pixels = unit.read(image_set)
                                .at(static_cast<std::size_t>(unit.image().index))
                                ->read({0, 0, info.columns, info.rows});
      image.on_ground = match_ground(pixels, image, terrain, metres_per_unit);
    }
    unit.count_in(0), unit.count_out(kept);
    unit.write(placed_observations, std::move(all));
    unit.write(image_view, std::move(image));
  }

  static std::string why_no_ground(const ImageView& image, const Terrain& terrain) {
    std::string text = "the image shows no ground of the DEM";
    if (!image.view) return text + ": they do not overlap";
    const auto line =
        sight(image, {static_cast<double>(image.columns - 1) / 2, static_cast<double>(image.rows - 1) / 2});
    if (!line) return text + ": the lens model has no answer for its middle";
    const auto below = terrain.height(line->origin.xyz.x(), line->origin.xyz.y());
    if (below && *below > line->origin.xyz.z())
      return text + fmt::format(
                        ": the camera is {:.4g} m under the ground; a vertical datum (geoid, areoid) "
                        "may be missing",
                        *below - line->origin.xyz.z());
    if (line->along.unit.z() >= 0) return text + ": the camera looks at the sky";
    return text + fmt::format(": from {:.1f}, {:.1f} it looks past the DEM's extent", line->origin.xyz.x(),
                              line->origin.xyz.y());
  }
};

}  // namespace

void register_stage_project_to_ground(Registry& registry);
void register_stage_project_to_ground(Registry& registry) {
  registry.add<ProjectToGround>();
}

}  // namespace waymark
