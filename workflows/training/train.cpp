// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/train.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <mutex>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "pipeline/craters/crater_training.hpp"
#include "pipeline/craters/patch_network_training.hpp"
#include "pipeline/craters/relief_training.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "workflows/training/crater_training_data.hpp"
#include "workflows/training/cratered_relief.hpp"
#include "workflows/training/marked_craters.hpp"
#include "workflows/training/rock_training_data.hpp"
#include "workflows/training/tree_training_data.hpp"
#include "workflows/training/treetop_training_data.hpp"

namespace waymark::workflows {
namespace {

constexpr int kSceneSide = 640;         // pixels of a scene of craters
constexpr std::uint64_t kNetworks = 3;  // of crater looks: their mean is at least as good as any of them
constexpr std::int64_t kCraterScenes = 120, kReliefScenes = 300, kTreeForests = 120;
constexpr std::int64_t kLabelledViews = 12;  // of each marked image
constexpr int kReliefRounds = 8;
constexpr int kParts = 3;  // of the images, left out in turn

// Names in the source file that a trained model is written as.
struct ModelSource {
  std::string made_by;     // the command, for people
  std::string header;      // that declares the function
  std::string type;        // what the function returns a reference to
  std::string name;        // of the function
  std::string parse;       // function that parses the model's text
  std::string where;       // name of the text in error messages
  std::size_t line = 140;  // characters of the text per line: a source file has at most 300 lines
};

// Returns the source of a function that parses the model's text once.
std::string model_as_source(const std::string& text, const ModelSource& source) {
  std::string code = fmt::format(
      "// SPDX-License-Identifier: Apache-2.0\n"
      "// Made by `{}`; do not edit.\n"
      "// clang-format off\n"
      "#include \"{}\"\n\nnamespace waymark::pipeline {{\n\n"
      "const {}& {}() {{\n"
      "  static const {} model = {}(\n",
      source.made_by, source.header, source.type, source.name, source.type, source.parse);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t line = text.find('\n', begin);
    const std::size_t end = std::min(begin + source.line, line == std::string::npos ? text.size() : line);
    const bool ends_line = end == line;
    code += fmt::format("      \"{}{}\"\n", text.substr(begin, end - begin), ends_line ? "\\n" : "");
    begin = ends_line ? end + 1 : end;
  }
  return code + fmt::format("      , \"{}\");\n  return model;\n}}\n\n}}  // namespace waymark::pipeline\n",
                            source.where);
}

// Writes a model, as source if the name ends in .cpp. Throws Error{output}.
void write_model(const std::string& path, const std::string& text, const ModelSource& source) {
  write_file(path, path.ends_with(".cpp") ? model_as_source(text, source) : text);
}

struct CraterExamples {
  std::vector<pipeline::CraterExample> bowls;
  std::vector<pipeline::WidePatchExample> patch_examples;
};

CraterExamples make_crater_examples(std::int64_t scenes, const Callbacks& callbacks) {
  CraterExamples examples;
  for (std::int64_t i = 0; i < scenes; ++i) {
    // In turn plain shading of relief that no testbed makes, and renderings of the testbed.
    const auto index = static_cast<std::uint64_t>(i / 2);
    const pipeline::LabelledScene scene =
        i % 2 == 0 ? pipeline::shaded_scene(index, kSceneSide) : make_testbed_scene(index, kSceneSide);
    const auto bowls = make_crater_examples(scene, index);
    examples.bowls.insert(examples.bowls.end(), bowls.begin(), bowls.end());
    const auto patches = pipeline::make_patch_examples(scene, static_cast<std::uint64_t>(i));
    examples.patch_examples.insert(examples.patch_examples.end(), patches.begin(), patches.end());
    if ((i + 1) % 20 == 0)
      callbacks.summary(fmt::format("{} of {} scenes, {} examples\n", i + 1, scenes, examples.bowls.size()));
  }
  return examples;
}

void write_crater_model(const TrainRequest& request, const std::string& text) {
  write_model(
      request.output, text,
      {"waymark train craters -o pipeline/craters/built_in_model.cpp", "pipeline/craters/crater_model.hpp",
       "CraterModel", "built_in_crater_model", "parse_crater_model", "the built-in crater model", 480});
}

TrainResult train_craters(const TrainRequest& request, const Callbacks& callbacks) {
  const std::int64_t scenes = request.scenes > 0 ? request.scenes : kCraterScenes;
  const CraterExamples examples = make_crater_examples(scenes, callbacks);
  pipeline::CraterTraining training{.seed = static_cast<std::uint64_t>(request.seed)};
  if (request.rounds > 0) training.rounds = static_cast<int>(request.rounds);
  pipeline::CraterModel model =
      pipeline::train_crater_model(examples.bowls, training, [&](int round, double loss) {
        callbacks.summary(fmt::format("round {}: loss {:.4f}\n", round + 1, loss));
      });
  for (std::uint64_t net = 0; net < kNetworks; ++net)
    model.convolution_nets.push_back(pipeline::train_patch_network(
        examples.patch_examples, training.rounds, training.seed + net, [&](int round, double loss) {
          callbacks.summary(fmt::format("looks, network {} of {}, round {}: loss {:.4f}\n", net + 1,
                                        kNetworks, round + 1, loss));
        }));
  model.trained_on =
      fmt::format("made-up and testbed scenes 0 to {}, {} px, {} examples, {} rounds, seed {}", scenes - 1,
                  kSceneSide, examples.bowls.size(), training.rounds, request.seed);
  TrainResult result{pipeline::as_text(model), model.trained_on};
  if (!request.output.empty()) write_crater_model(request, result.model);
  return result;
}

std::vector<pipeline::CraterExample> make_relief_examples(const std::vector<std::string>& relief,
                                                          std::int64_t scenes, const Callbacks& callbacks) {
  std::vector<pipeline::CrateredRelief> measured;
  for (const std::string& one : relief) measured.push_back(read_cratered_relief(one, kSceneSide));
  std::vector<std::vector<pipeline::CraterExample>> of_scene(static_cast<std::size_t>(scenes));
  pipeline::ProgressMeter meter(callbacks.progress, "scenes of relief", scenes);
  tbb::parallel_for(std::size_t{0}, of_scene.size(), [&](std::size_t i) {
    of_scene[i] = pipeline::make_relief_examples(
        pipeline::relief_scene(measured[i % measured.size()], i, kSceneSide), i);
    meter.add(1);
  });
  meter.finish();
  std::vector<pipeline::CraterExample> examples;
  for (const auto& some : of_scene) examples.insert(examples.end(), some.begin(), some.end());
  return examples;
}

std::vector<pipeline::CraterExample> make_labelled_examples(const std::vector<std::string>& labels,
                                                            std::int64_t views, const Callbacks& callbacks) {
  std::vector<pipeline::CraterExample> examples;
  for (const std::string& one : labels) {
    const pipeline::LabelledScene scene = read_marked_craters(one);
    callbacks.summary(fmt::format("{}: {} craters, light from {:.0f} degrees\n", one, scene.craters.size(),
                                  scene.sun_angle.value / kRadiansPerDegree));
    for (std::int64_t view = 0; view < views; ++view) {
      const auto some = pipeline::make_relief_examples(scene, static_cast<std::uint64_t>(view));
      examples.insert(examples.end(), some.begin(), some.end());
    }
  }
  return examples;
}

TrainResult train_crater_verifier(const TrainRequest& request, const Callbacks& callbacks) {
  const bool marked = !request.labels.empty();
  const std::int64_t scenes = request.scenes > 0 ? request.scenes : marked ? kLabelledViews : kReliefScenes;
  const auto examples = marked ? make_labelled_examples(request.labels, scenes, callbacks)
                               : make_relief_examples(request.relief, scenes, callbacks);
  const auto craters = std::ranges::count_if(examples, &pipeline::CraterExample::crater);
  if (craters == 0 || craters == std::ssize(examples))
    throw Error(ErrorCode::input,
                fmt::format("the model found {} circles, {} of them craters of the {}", examples.size(),
                            craters, marked ? "table" : "catalogue"),
                marked ? request.labels[0] : request.relief[0],
                marked ? "check that the table belongs to the image, in pixels, and marks all craters"
                       : "check that the catalogue belongs to the DEM");
  pipeline::CraterTraining training{.seed = static_cast<std::uint64_t>(request.seed)};
  training.rounds = request.rounds > 0 ? static_cast<int>(request.rounds) : kReliefRounds;
  std::mutex one_at_a_time;
  auto verifier = pipeline::train_relief_verifier(
      examples, training, static_cast<int>(kNetworks), [&](int network, int round, double loss) {
        const std::scoped_lock lock(one_at_a_time);
        callbacks.summary(fmt::format("network {} of {}, round {}: loss {:.4f}\n", network + 1, kNetworks,
                                      round + 1, loss));
      });
  verifier.trained_on =
      marked ? fmt::format(
                   "{} views of each of {} marked images, {} examples, {} of them craters, {} rounds, "
                   "seed {}",
                   scenes, request.labels.size(), examples.size(), craters, training.rounds, request.seed)
             : fmt::format("{} images of {} areas of measured relief, {} px, {} examples, {} rounds, seed {}",
                           scenes, request.relief.size(), kSceneSide, examples.size(), training.rounds,
                           request.seed);
  TrainResult result{as_text(verifier), verifier.trained_on};
  if (!request.output.empty())
    write_model(request.output, result.model,
                {marked ? "waymark train craters --labels IMAGE,TABLE"
                        : "waymark train craters --relief DEM,CATALOGUE",
                 "pipeline/craters/relief_verifier.hpp", "ReliefVerifier", "built_in_relief_verifier",
                 "parse_relief_verifier", "the built-in verifier of craters", 560});
  return result;
}

void write_crown_network(const TrainRequest& request, const std::string& text) {
  const std::string name = request.colour ? "crown_network_colour" : "crown_network_infrared";
  write_model(request.output, text,
              {fmt::format("waymark train trees IMAGE...{} -o pipeline/forest/{}.cpp",
                           request.colour ? " --colour" : "", name),
               "pipeline/forest/crown_network.hpp", "DenseNetwork", name, "parse_crown_network",
               "a built-in crown network"});
}

TrainResult train_crowns(const TrainRequest& request, const Callbacks& callbacks) {
  std::vector<TreeTrainingImage> images;
  std::size_t trees = 0;
  for (const std::string& image : request.images) {
    images.push_back(read_training_image(image, !request.colour));
    trees += images.back().trees.size();
  }
  pipeline::NetworkTraining training{.seed = static_cast<std::uint64_t>(request.seed)};
  if (request.rounds > 0) training.rounds = static_cast<int>(request.rounds);
  const bool validate = images.size() >= kParts;
  pipeline::ProgressMeter meter(callbacks.progress, "train trees",
                                training.rounds * (validate ? kParts + 1 : 1));
  std::string held_out;
  if (validate) {
    const testbed::Score score = cross_validate(images, kParts, training, request.threads, meter);
    held_out = fmt::format("; left out in turn, {} parts: precision {:.3f}, recall {:.3f}, F1 {:.3f}", kParts,
                           score.all.precision(), score.all.recall(), score.all.f1());
    for (const testbed::CalibrationBin& bin : score.by_confidence)
      callbacks.summary(fmt::format("confidence {:.2f} to {:.2f}: {} of {} are trees\n", bin.from, bin.to,
                                    bin.right, bin.found));
  }
  pipeline::DenseNetwork network = train_crown_network(images, training, meter);
  meter.finish();
  network.trained_on = fmt::format("{} images, {} trees, {} rounds, seed {}{}", images.size(), trees,
                                   training.rounds, request.seed, held_out);
  callbacks.summary(network.trained_on + "\n");
  TrainResult result{pipeline::crown_network_as_text(network), network.trained_on};
  if (!request.output.empty()) write_crown_network(request, result.model);
  return result;
}

TrainResult train_treetops(const TrainRequest& request, const Callbacks& callbacks) {
  if (request.colour || request.rounds > 0)
    throw Error(ErrorCode::usage, "--colour and --rounds are for trees in images, and no image is given", "",
                "name orthophotos whose trees are marked, or leave the options out");
  const std::int64_t forests = request.scenes > 0 ? request.scenes : kTreeForests;
  const pipeline::TreeConfidenceModel model =
      train_tree_confidence(static_cast<int>(forests), request.threads, callbacks.progress);
  callbacks.summary(model.trained_on + "\n");
  TrainResult result{pipeline::as_text(model), model.trained_on};
  if (!request.output.empty())
    write_model(request.output, result.model,
                {"waymark train trees -o pipeline/forest/built_in_tree_confidence.cpp",
                 "pipeline/forest/tree_confidence.hpp", "TreeConfidenceModel", "built_in_tree_confidence",
                 "parse_tree_confidence", "the built-in confidence of treetops"});
  return result;
}

TrainResult train_rocks(const TrainRequest& request, const Callbacks& callbacks) {
  const int views = request.scenes > 0 ? static_cast<int>(request.scenes) : kRockViews;
  const RockTrainingSets sets = make_rock_examples(views, request.threads, callbacks.progress);
  pipeline::RockTraining training{.seed = static_cast<std::uint64_t>(request.seed)};
  if (request.rounds > 0) training.rounds = static_cast<int>(request.rounds);
  // Each half is written and read, so that the average is of numbers with four digits.
  const auto half = [&](const std::vector<pipeline::RockExample>& examples) {
    callbacks.summary(fmt::format("{} dark spots\n", examples.size()));
    return pipeline::parse_rock_network(as_text(pipeline::train_rock_network(examples, training)),
                                        "a trained half");
  };
  pipeline::RockNetwork network = average_networks(half(sets.first), half(sets.second));
  network.trained_on =
      fmt::format("{} testbed views, drawn and oblique ones in proportion, {} rounds, seed {}", views,
                  training.rounds, request.seed);
  TrainResult result{as_text(network), network.trained_on};
  if (!request.output.empty())
    write_model(
        request.output, result.model,
        {"waymark train rocks -o pipeline/rocks/built_in_rock_network.cpp", "pipeline/rocks/rock_network.hpp",
         "RockNetwork", "built_in_rock_network", "parse_rock_network", "the built-in rock network", 480});
  return result;
}

}  // namespace

TrainResult train(const TrainRequest& request, const Callbacks& callbacks) {
  check_number("--scenes", static_cast<double>(request.scenes), "",
               {.help = "Scenes or views to train on; 0: the usual number", .min = 0});
  check_number("--rounds", static_cast<double>(request.rounds), "",
               {.help = "Passes over the examples; 0: the usual number", .min = 0});
  if (!request.relief.empty() && request.what != "craters")
    throw Error(ErrorCode::usage, "--relief is for craters", "train " + request.what);
  if (!request.labels.empty() && request.what != "craters")
    throw Error(ErrorCode::usage, "--labels is for craters", "train " + request.what);
  if (!request.labels.empty() && !request.relief.empty())
    throw Error(ErrorCode::usage, "--labels and --relief both say what the verifier is trained on",
                "train craters", "keep one");
  if (request.what == "trees")
    return request.images.empty() ? train_treetops(request, callbacks) : train_crowns(request, callbacks);
  if (!request.images.empty())
    throw Error(ErrorCode::usage, request.what + " are trained on made scenes, not on images",
                request.images[0]);
  if (!request.relief.empty() || !request.labels.empty()) return train_crater_verifier(request, callbacks);
  return request.what == "rocks" ? train_rocks(request, callbacks) : train_craters(request, callbacks);
}

}  // namespace waymark::workflows
