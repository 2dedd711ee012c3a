// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/train.hpp"

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "core/error.hpp"
#include "workflows/training/train_sensor.hpp"

namespace waymark::apps {
namespace {

class Train final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "train",
        .group = Group::make,
        .summary = "Train the models that find craters, rocks and trees, or fit a sensor profile",
        .about =
            "craters: makes scenes with known craters, half of them with the testbed of `waymark "
            "simulate`, detects bowls in them and trains a classifier of craters and a model of their "
            "rims. No third-party image is used. With --relief, trains the verifier of what that "
            "classifier finds, on images shaded from measured relief whose craters are catalogued. With "
            "--labels, trains it on your own images, for `waymark detect craters --verifier`.\n\n"
            "rocks: renders synthetic rocks, most of them with the testbed, detects dark spots and trains a "
            "network "
            "that separates shadows of rocks from others and corrects their sizes.\n\n"
            "trees: without images, trains the confidence of treetops in canopy height models on synthetic "
            "forests. With images, trains the network of crowns on orthophotos whose trees are all marked, "
            "in a table beside each (a.csv beside a.tif: x, y in pixels), and reports the score on images "
            "that were left out.\n\n"
            "sensor: fits range, field of view, noise and the probability of detection by range and size to "
            "logs with true poses and the map of their site, and writes a sensor file.\n\n"
            "The same scenes, images and seed give the same model. A name that ends in .cpp gives the "
            "source file that is compiled into waymark.",
        .arguments =
            {Argument{"", "WHAT", &request_.what, "What to train"}.needed().one_of(
                 {"craters", "rocks", "trees", "sensor"}),
             Argument{"", "FILE...", &request_.images, "trees: orthophotos to train on; sensor: logs"}
                 .offering(Offer::file),
             Argument{"-o,--output", "MODEL", &request_.output, "Model to write, .txt or .cpp; sensor: .json"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--map", "MAP", &map_, "sensor: map of the site of the logs"}.offering(Offer::file),
             {"--scenes", "N", &request_.scenes,
              "Synthetic scenes to train on; 0: 120 of craters, 300 of relief, 240 of rocks, 120 forests of "
              "each type. With --labels views of each image; 0: 12"},
             Argument{"--relief", "DEM,CATALOGUE", &request_.relief,
                      "craters: relief without gaps, and a table of all its craters: lon, lat (degrees), "
                      "diameter, depth (metres)"}
                 .offering(Offer::file),
             Argument{"--labels", "IMAGE,TABLE", &request_.labels,
                      "craters: image, and a table of all its craters: x, y, diameter in pixels"}
                 .offering(Offer::file),
             {"--colour", "", &request_.colour, "trees in images: train on red, green and blue alone"},
             {"--rounds", "N", &request_.rounds, "Passes over all examples; 0: the default of the model"},
             {"--seed", "N", &request_.seed, "Another seed gives other initial weights and another order"},
             format_option(&format_)},
        .examples =
            {{"waymark train craters -o pipeline/craters/built_in_model.cpp", "The shipped model"},
             {"waymark train craters -o quick.txt --scenes 20", "A quick one, to try"},
             {"waymark train craters --relief gld100.tif,lu.csv -o verifier.txt",
              "A verifier of craters, from lunar relief"},
             {"waymark train craters --labels mine.png,mine.csv --labels next.png,next.csv -o verifier.txt",
              "A verifier of craters, from marked images"},
             {"waymark train rocks -o pipeline/rocks/built_in_rock_network.cpp", "The shipped network"},
             {"waymark train trees -o pipeline/forest/built_in_tree_confidence.cpp",
              "Confidence of treetops in canopy models"},
             {"waymark train trees naip/*.tif -o pipeline/forest/crown_network_infrared.cpp",
              "Trees in images with near infrared"},
             {"waymark train sensor drive1.jsonl drive2.jsonl --map site.gpkg -o mine.json",
              "A sensor profile from drives with true poses"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    if (request_.what == "sensor") {
      const SensorProfile sensor = workflows::train_sensor({request_.images, map_, request_.output},
                                                           console_callbacks(session, format_));
      print_trained(sensor.summary);
      return 0;
    }
    if (!map_.empty())
      throw Error(ErrorCode::usage, "--map is for `waymark train sensor`", "train " + request_.what);
    request_.threads = static_cast<int>(session.threads);
    print_trained(workflows::train(request_, console_callbacks(session, format_)).trained_on);
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"what", ResultKind::text, "What was trained"},
            {"model", ResultKind::text, "Model or sensor file that was written"},
            {"trained_on", ResultKind::text, "Scenes, images or logs, examples, rounds and seed"}};
  }

  void print_trained(const std::string& trained_on) const {
    if (format_ == "json")
      print_result(result_keys(),
                   {{"what", request_.what}, {"model", request_.output}, {"trained_on", trained_on}});
  }

  std::string format_ = "text";
  workflows::TrainRequest request_;
  std::string map_;
};

}  // namespace

void register_command_train(CommandTable& commands);
void register_command_train(CommandTable& commands) {
  commands.add<Train>();
}

}  // namespace waymark::apps
