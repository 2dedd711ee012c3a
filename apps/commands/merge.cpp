// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/mapping/merge_maps.hpp"

namespace waymark::apps {
namespace {

class Merge final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "merge",
        .group = Group::make,
        .summary = "Merge maps of one CRS into one",
        .about =
            "Landmarks of one type that lie within their covariances, with similar sizes, become one, as the "
            "observations of several images do. Its position, features, counts and confidence are those of "
            "both. All observations, images, layers and runs are kept, once. A landmark whose observations "
            "are all in the other map does not count twice.\n\n"
            "Types are merged with all of their features. The result does not depend on the order of the "
            "maps. Images of one map do not count against landmarks of the other that they missed. Elevation "
            "tiles are left out. The maps are read into memory.",
        .arguments = {Argument{"", "MAP.gpkg...", &request_.maps, "Maps, two or more"}.needed().offering(
                          Offer::file),
                      Argument{"-o,--output", "MAP.gpkg", &request_.result, "Map to write"}.needed().offering(
                          Offer::file),
                      Argument{"--aoi", "POLYGONS", &request_.aoi,
                               "Area of interest, in any CRS of the body: the merged landmarks inside"}
                          .offering(Offer::file),
                      {"--changes", "", &request_.changes,
                       "Compare two maps, the earlier one first: layer change of the result"},
                      {"--max-move", "METRES", &request_.max_move,
                       "Largest distance of a landmark that moved; what is farther is gone and new"},
                      format_option(&format_)},
        .examples = {{"waymark merge north.gpkg south.gpkg -o site.gpkg", "Two flights over one site"},
                     {"waymark merge spring.gpkg autumn.gpkg --changes -o site.gpkg",
                      "What is gone, new or moved since spring"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    const workflows::MergeResult done = workflows::merge_maps(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(), {{"map", request_.result},
                                   {"maps", static_cast<std::int64_t>(request_.maps.size())},
                                   {"landmarks", done.landmarks},
                                   {"fused", done.fused},
                                   {"identical", done.identical},
                                   {"gone", changes(done.gone)},
                                   {"new", changes(done.appeared)},
                                   {"moved", changes(done.moved)},
                                   {"unchanged", changes(done.unchanged)},
                                   {"not_covered", changes(done.not_covered)}});
    return 0;
  }

 private:
  /// Returns a number of changes, null if they were not requested.
  ResultValue changes(std::int64_t number) const {
    return request_.changes ? ResultValue(number) : ResultValue();
  }

  static std::vector<ResultKey> result_keys() {
    return {{"map", ResultKind::text, "Map that was written"},
            {"maps", ResultKind::integer, "Maps that were read"},
            {"landmarks", ResultKind::integer, "Landmarks of the written map"},
            {"fused", ResultKind::integer, "Landmarks of several maps, by different observations"},
            {"identical", ResultKind::integer, "Landmarks of several maps, by the same observations"},
            {"gone", ResultKind::integer, "Landmarks of the first map alone; null without --changes"},
            {"new", ResultKind::integer, "Landmarks of the second map alone; null without --changes"},
            {"moved", ResultKind::integer, "Landmarks that moved; null without --changes"},
            {"unchanged", ResultKind::integer, "Landmarks of both maps, not moved; null without --changes"},
            {"not_covered", ResultKind::integer,
             "Landmarks of one map where the other shows nothing; null without --changes"}};
  }

  std::string format_ = "text";
  workflows::MergeRequest request_;
};

}  // namespace

void register_command_merge(CommandTable& commands);
void register_command_merge(CommandTable& commands) {
  commands.add<Merge>();
}

}  // namespace waymark::apps
