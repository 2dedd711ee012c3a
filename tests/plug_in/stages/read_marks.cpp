// SPDX-License-Identifier: Apache-2.0
#include "core/detection.hpp"
#include "geo/image_source.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "tests/plug_in/marks.hpp"
namespace waymark::test {
namespace {

/// Detector of a made world, whose objects are single pixels of one value for each kind of object.
struct ReadMarks {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr pipeline::In<ImageSet> image_set{"image_set"};
  static constexpr pipeline::Out<std::vector<Detection>> detections{"detections"};
  static pipeline::StageSpec spec() {
    return {.name = "read_marks",
            .summary = "Finds objects that are marked by single pixels",
            .scope = pipeline::Scope::image,
            .inputs = {image_set},
            .outputs = {detections}};
  }
  static void run(const Options&, pipeline::StageContext& unit) {
    const ImageSource& image = *unit.read(image_set).at(static_cast<std::size_t>(unit.image().index));
    const ImageInfo& info = image.info();
    const Pixels pixels = image.read({0, 0, info.columns, info.rows});
    std::vector<Detection> found;
    for (std::int64_t row = 0; row < info.rows; ++row)
      for (std::int64_t column = 0; column < info.columns; ++column)
        for (const Mark& mark : kMarks) {
          if (static_cast<int>(pixels(column, row)) != mark.value) continue;
          Detection one;
          one.type = unit.types().id(mark.type);
          one.outline = {static_cast<double>(column), static_cast<double>(row), mark.diameter, mark.diameter,
                         0};
          one.diameter_sd = 0.3;
          if (mark.shadow > 0) one.shadow_reach = MeasuredValue{mark.shadow, 0.5};
          one.confidence = 0.9;
          found.push_back(one);
        }
    unit.count_out(std::ssize(found));
    unit.write(detections, std::move(found));
  }
};

}  // namespace

void register_stage_read_marks(pipeline::Registry& registry);
void register_stage_read_marks(pipeline::Registry& registry) {
  registry.add<ReadMarks>();
}

}  // namespace waymark::test
