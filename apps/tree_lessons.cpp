// SPDX-License-Identifier: Apache-2.0
#include "apps/tree_lessons.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "apps/crowns_in_image.hpp"
#include "apps/scored_table.hpp"
#include "core/error.hpp"
#include "importers/images/image.hpp"

namespace waymark {
namespace {

constexpr double kLargestError = 6;  // metres
constexpr double kApart = 1e6;       // metres: images are scored together, and must not meet
constexpr int kVariants = 2;         // in other light

NetworkExamples examples_of(const std::vector<const TreeLesson*>& lessons) {
  NetworkExamples examples;
  for (std::size_t i = 0; i < lessons.size(); ++i) {
    const ColourImage& image = *lessons[i]->image;
    add_crown_examples(examples, image.read({0, 0, image.columns(), image.rows()}), lessons[i]->trees,
                       kVariants, i);
  }
  return examples;
}

DenseNetwork learn(const std::vector<const TreeLesson*>& lessons, const NetworkTraining& training,
                   ProgressMeter& meter) {
  return train_network(examples_of(lessons), training, [&meter](int, double) { meter.add(1); });
}

/// A table may say that an image shows no tree at all: a header, or nothing.
bool says_nothing(const std::filesystem::path& table) {
  std::ifstream file(table);
  std::string line;
  int rows = 0;
  while (std::getline(file, line)) rows += line.find_first_not_of(" \r") != std::string::npos;
  return file.eof() && rows <= 1;
}

}  // namespace

TreeLesson tree_lesson(const std::string& path, bool infrared) {
  const ImageInfo info = import_image(path)->info();
  if (!info.ortho || info.ortho->crs.kind() == CrsKind::local)
    throw Error(ErrorCode::input, "an image to learn from must be an orthophoto in metres", path);
  const double metres = std::sqrt(-info.ortho->dx * info.ortho->dy) * info.ortho->crs.metres_per_unit();
  TreeLesson lesson;
  lesson.image = std::make_shared<const ColourImage>(info, metres, infrared ? 4 : 3);
  if (infrared && !lesson.image->infrared())
    throw Error(ErrorCode::input, "the image has no fourth band of near infrared", path,
                "--colour learns from red, green and blue alone");
  const auto across = static_cast<double>(lesson.image->pixels_per_cell());
  const auto table = std::filesystem::path(path).replace_extension(".csv");
  if (says_nothing(table)) return lesson;
  for (const auto& [type, things] : scored_things(table.string(), "", 0))
    for (const ScoredThing& tree : things)
      lesson.trees.push_back({(tree.at.x() + 0.5) / across - 0.5, (tree.at.y() + 0.5) / across - 0.5});
  return lesson;
}

DenseNetwork crown_network_of(const std::vector<TreeLesson>& lessons, const NetworkTraining& training,
                              ProgressMeter& meter) {
  std::vector<const TreeLesson*> all;
  for (const TreeLesson& lesson : lessons) all.push_back(&lesson);
  return learn(all, training, meter);
}

Score held_out_score(const std::vector<TreeLesson>& lessons, int parts, const NetworkTraining& training,
                     int threads, ProgressMeter& meter) {
  std::vector<ScoredThing> found, truth;
  const auto count = static_cast<std::size_t>(parts);
  for (std::size_t part = 0; part < count; ++part) {
    std::vector<const TreeLesson*> others;
    for (std::size_t i = 0; i < lessons.size(); ++i)
      if (i % count != part) others.push_back(&lessons[i]);
    const DenseNetwork network = learn(others, training, meter);
    for (std::size_t i = part; i < lessons.size(); i += count) {
      const ColourImage& image = *lessons[i].image;
      const auto metres = [&, i](double x, double y) {
        ScoredThing thing;
        thing.at << x * image.cell() + kApart * double(i), y * image.cell();
        return thing;
      };
      for (const CrownInImage& crown : crowns_in_image(image, network, threads)) {
        if (crown.confidence < 0.5) continue;
        const auto across = static_cast<double>(image.pixels_per_cell());
        found.push_back(metres((crown.x + 0.5) / across - 0.5, (crown.y + 0.5) / across - 0.5));
        found.back().confidence = crown.confidence;
      }
      for (const MarkedTree& tree : lessons[i].trees) truth.push_back(metres(tree.x, tree.y));
    }
  }
  MatchRules rules;
  rules.share = 0, rules.least = kLargestError, rules.size_ratio = 0;
  return score(found, truth, rules);
}

}  // namespace waymark
