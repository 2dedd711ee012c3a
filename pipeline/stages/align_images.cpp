// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/alignment.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/projection/dem_terrain.hpp"
#include "pipeline/fusion/projection/image_view_codec.hpp"

namespace waymark::pipeline {
namespace {

struct AlignImages {
  struct Options {
    bool enabled = true;
    std::int64_t max_images = AlignmentRules{}.max_images;
    void describe(OptionVisitor& option) {
      option("enabled", enabled, {.help = "Correct poses; false leaves them as given"});
      option("max_images", max_images,
             {.help = "Most images that are aligned; the time grows with the third power",
              .min = 2,
              .max = 2000,
              .formerly = "most_images"});
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
            .version = 4,
            .scope = Scope::map,
            .inputs = {dem, image_view, cleaned},
            .outputs = {observations, aligned_views}};
  }

  static void run(const Options& options, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    std::vector<ImageView> images;
    for (const auto& image : unit.read_all(image_view)) images.push_back(*image);
    const DemHandle& ground = unit.read(dem);
    Alignment aligned{unit.read(cleaned), std::move(images), {}, 0, false};
    if (options.enabled) {
      AlignmentRules rules;
      rules.max_images = static_cast<int>(options.max_images);
      aligned = align_images(std::move(aligned.observations), std::move(aligned.images), load_terrain(ground),
                             types, ground->geometry().where.crs, rules);
    }
    if (aligned.too_many)
      unit.warn(fmt::format("{} images are not aligned: max_images allows {}", aligned.images.size(),
                            options.max_images));
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
