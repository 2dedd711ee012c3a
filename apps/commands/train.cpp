// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/crater_lessons.hpp"
#include "apps/log.hpp"
#include "apps/model_source.hpp"
#include "apps/progress.hpp"
#include "apps/session.hpp"
#include "apps/tree_lessons.hpp"
#include "core/error.hpp"
#include "pipeline/craters/crater_training.hpp"
#include "pipeline/craters/look_training.hpp"

namespace waymark {
namespace {

class Train final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "train",
        .group = Group::make,
        .summary = "Train the models that tell craters and, in colour images, trees",
        .about =
            "craters: makes scenes with known craters, half of them with the testbed of `waymark simulate`, "
            "finds bowls in them and learns which are craters and where their rims are. No image that anyone "
            "else owns goes in.\n\n"
            "trees: learns from orthophotos whose trees are all marked, in a table beside each (a.csv beside "
            "a.tif: x, y in pixels), and tells how well images that were left out are searched.\n\n"
            "The same scenes, images and seed give the same model. A name that ends in .cpp gives the source "
            "file that is compiled into waymark.",
        .arguments =
            {Argument{"", "WHAT", &what_, "What to train"}.needed().one_of({"craters", "trees"}),
             Argument{"", "IMAGE...", &images_, "trees: orthophotos to learn from"}.offering(Offer::file),
             Argument{"-o,--output", "MODEL", &output_, "Model to write, .txt or .cpp"}.needed().offering(
                 Offer::file),
             {"--scenes", "N", &scenes_, "craters: scenes to learn from; each takes about two seconds"},
             {"--colour", "", &colour_, "trees: learn from red, green and blue alone"},
             {"--rounds", "N", &rounds_, "Times through all examples; 0: as usual"},
             {"--seed", "N", &seed_, "Another seed gives other first weights and another order"}},
        .examples = {{"waymark train craters -o pipeline/craters/built_in_model.cpp", "The model we ship"},
                     {"waymark train craters -o quick.txt --scenes 20", "A quick one, to try"},
                     {"waymark train trees naip/*.tif -o pipeline/forest/crown_network_infrared.cpp",
                      "Trees in images with near infrared"}}};
  }

  int run(const Session& session) override {
    if (scenes_ < 1 || rounds_ < 0)
      throw Error(ErrorCode::usage, "there must be at least one scene and one round", "",
                  "leave out --scenes and --rounds for the usual");
    if (what_ == "trees") return train_trees(session);
    if (!images_.empty())
      throw Error(ErrorCode::usage, "craters are learnt from made scenes, not from images", images_[0]);
    return train_craters(session);
  }

 private:
  static constexpr int kSide = 640;              // pixels
  static constexpr std::uint64_t kNetworks = 3;  // of looks: their mean is as good as any of them, or better

  int train_craters(const Session& session) const {
    std::vector<CraterExample> examples;
    std::vector<LookExample> looks;
    for (std::int64_t i = 0; i < scenes_; ++i) {
      // By turns plain shading of relief no testbed makes, and what the testbed renders.
      const auto index = static_cast<std::uint64_t>(i / 2);
      const KnownScene scene = i % 2 == 0 ? shaded_scene(index, kSide) : testbed_lesson(index, kSide);
      const auto more = examples_of(scene, index);
      examples.insert(examples.end(), more.begin(), more.end());
      const auto more_looks = looks_of(scene, static_cast<std::uint64_t>(i));
      looks.insert(looks.end(), more_looks.begin(), more_looks.end());
      if ((i + 1) % 20 == 0 && !session.quiet)
        say(fmt::format("{} of {} scenes, {} examples\n", i + 1, scenes_, examples.size()));
    }
    CraterTraining training{.seed = static_cast<std::uint64_t>(seed_)};
    if (rounds_ > 0) training.rounds = static_cast<int>(rounds_);
    CraterModel model = train_crater_model(examples, training, [&](int round, double loss) {
      if (!session.quiet) say(fmt::format("round {}: loss {:.4f}\n", round + 1, loss));
    });
    for (std::uint64_t net = 0; net < kNetworks; ++net)
      model.looks.push_back(
          train_looks(looks, training.rounds, training.seed + net, [&](int round, double loss) {
            if (!session.quiet)
              say(fmt::format("looks, network {} of {}, round {}: loss {:.4f}\n", net + 1, kNetworks,
                              round + 1, loss));
          }));
    model.trained_on =
        fmt::format("made-up and testbed scenes 0 to {}, {} px, {} examples, {} rounds, seed {}", scenes_ - 1,
                    kSide, examples.size(), training.rounds, seed_);
    write_model(
        output_, as_text(model),
        {"waymark train craters -o pipeline/craters/built_in_model.cpp", "pipeline/craters/crater_model.hpp",
         "CraterModel", "built_in_crater_model", "parse_crater_model", "the built-in crater model", 480});
    return 0;
  }

  int train_trees(const Session& session) const {
    if (images_.empty()) throw Error(ErrorCode::usage, "trees are learnt from images, and none is given");
    std::vector<TreeLesson> lessons;
    std::size_t trees = 0;
    for (const std::string& image : images_) {
      lessons.push_back(tree_lesson(image, !colour_));
      trees += lessons.back().trees.size();
    }
    NetworkTraining training{.seed = static_cast<std::uint64_t>(seed_)};
    if (rounds_ > 0) training.rounds = static_cast<int>(rounds_);
    const bool leave_out = lessons.size() >= kParts;
    const ProgressMeter::Listener listener = progress_renderer(session);
    ProgressMeter meter(listener, "train trees", training.rounds * (leave_out ? kParts + 1 : 1));
    std::string held_out;
    if (leave_out) {
      const Score score = held_out_score(lessons, kParts, training, static_cast<int>(session.threads), meter);
      held_out = fmt::format("; left out in turn, {} parts: precision {:.3f}, recall {:.3f}, F1 {:.3f}",
                             kParts, score.all.precision(), score.all.recall(), score.all.f1());
      for (const CalibrationBin& bin : score.by_confidence)
        say(fmt::format("told {:.2f} to {:.2f}: {} of {} are trees\n", bin.from, bin.to, bin.right,
                        bin.found));
    }
    DenseNetwork network = crown_network_of(lessons, training, meter);
    meter.finish();
    network.trained_on = fmt::format("{} images, {} trees, {} rounds, seed {}{}", lessons.size(), trees,
                                     training.rounds, seed_, held_out);
    say(network.trained_on + "\n");
    const std::string name = colour_ ? "crown_network_colour" : "crown_network_infrared";
    write_model(output_, as_text(network),
                {fmt::format("waymark train trees IMAGE...{} -o pipeline/forest/{}.cpp",
                             colour_ ? " --colour" : "", name),
                 "pipeline/forest/crown_network.hpp", "DenseNetwork", name, "parse_dense_network",
                 "a built-in crown network"});
    return 0;
  }

  static constexpr int kParts = 3;
  std::string what_, output_;
  std::vector<std::string> images_;
  bool colour_ = false;
  std::int64_t scenes_ = 120, rounds_ = 0, seed_ = 1;
};

}  // namespace

void register_command_train(CommandTable& commands);
void register_command_train(CommandTable& commands) {
  commands.add<Train>();
}

}  // namespace waymark
