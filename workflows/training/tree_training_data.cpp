// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/tree_training_data.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "importers/images/image.hpp"
#include "workflows/detection/crown_detection.hpp"
#include "workflows/evaluation/scored_table.hpp"

namespace waymark::workflows {
namespace {

constexpr double kMaxError = 6;   // metres
constexpr double kSpacing = 1e6;  // metres: images are scored together, and must not meet
constexpr int kVariants = 2;      // in other light

pipeline::NetworkExamples examples_of(const std::vector<const TreeTrainingImage*>& images) {
  pipeline::NetworkExamples examples;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const ColourImage& image = *images[i]->image;
    pipeline::add_crown_examples(examples, image.read({0, 0, image.columns(), image.rows()}),
                                 images[i]->trees, kVariants, i);
  }
  return examples;
}

pipeline::DenseNetwork train(const std::vector<const TreeTrainingImage*>& images,
                             const pipeline::NetworkTraining& training, pipeline::ProgressMeter& meter) {
  return pipeline::train_network(examples_of(images), training, [&meter](int, double) { meter.add(1); });
}

/// Returns true for a table without rows, as of an image without trees.
bool is_empty_table(const std::filesystem::path& table) {
  std::istringstream text(read_text(table, "the table of trees"));
  int rows = 0;
  for (std::string line; std::getline(text, line);)
    rows += line.find_first_not_of(" \r") != std::string::npos;
  return rows <= 1;
}

}  // namespace

TreeTrainingImage read_training_image(const std::string& path, bool infrared) {
  const ImageInfo info = importers::import_image(path)->info();
  if (!info.ortho || info.ortho->crs.kind() == CrsKind::local)
    throw Error(ErrorCode::input, "a training image must be an orthophoto in metres", path);
  const double metres = std::sqrt(-info.ortho->dx * info.ortho->dy) * info.ortho->crs.metres_per_unit();
  TreeTrainingImage marked;
  marked.image = std::make_shared<const ColourImage>(info, metres, infrared ? 4 : 3);
  if (infrared && !marked.image->infrared())
    throw Error(ErrorCode::input, "the image has no fourth band of near infrared", path,
                "--colour trains on red, green and blue alone");
  const auto across = static_cast<double>(marked.image->pixels_per_cell());
  const auto table = std::filesystem::path(path).replace_extension(".csv");
  if (is_empty_table(table)) return marked;
  for (const auto& [type, things] : read_scored_things(table.string(), "", 0))
    for (const testbed::EvaluatedObject& tree : things)
      marked.trees.push_back({(tree.at.x() + 0.5) / across - 0.5, (tree.at.y() + 0.5) / across - 0.5});
  return marked;
}

pipeline::DenseNetwork train_crown_network(const std::vector<TreeTrainingImage>& images,
                                           const pipeline::NetworkTraining& training,
                                           pipeline::ProgressMeter& meter) {
  std::vector<const TreeTrainingImage*> all;
  for (const TreeTrainingImage& marked : images) all.push_back(&marked);
  return train(all, training, meter);
}

testbed::Score cross_validate(const std::vector<TreeTrainingImage>& images, int parts,
                              const pipeline::NetworkTraining& training, int threads,
                              pipeline::ProgressMeter& meter) {
  std::vector<testbed::EvaluatedObject> found, truth;
  const auto count = static_cast<std::size_t>(parts);
  for (std::size_t part = 0; part < count; ++part) {
    std::vector<const TreeTrainingImage*> others;
    for (std::size_t i = 0; i < images.size(); ++i)
      if (i % count != part) others.push_back(&images[i]);
    const pipeline::DenseNetwork network = train(others, training, meter);
    for (std::size_t i = part; i < images.size(); i += count) {
      const ColourImage& image = *images[i].image;
      const auto metres = [&, i](double x, double y) {
        testbed::EvaluatedObject thing;
        thing.at << x * image.cell() + kSpacing * double(i), y * image.cell();
        return thing;
      };
      for (const DetectedCrown& crown : detect_crowns(image, network, threads)) {
        if (crown.confidence < 0.5) continue;
        const auto across = static_cast<double>(image.pixels_per_cell());
        found.push_back(metres((crown.x + 0.5) / across - 0.5, (crown.y + 0.5) / across - 0.5));
        found.back().confidence = crown.confidence;
      }
      for (const pipeline::MarkedTree& tree : images[i].trees) truth.push_back(metres(tree.x, tree.y));
    }
  }
  testbed::MatchRules rules;
  rules.distance_fraction = 0, rules.min_distance = kMaxError, rules.size_ratio = 0;
  return testbed::score(found, truth, rules);
}

}  // namespace waymark::workflows
