// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>

#include "apps/command.hpp"
#include "apps/crater_lessons.hpp"
#include "apps/log.hpp"
#include "apps/session.hpp"
#include "core/error.hpp"
#include "pipeline/craters/crater_training.hpp"

namespace waymark {
namespace {

constexpr std::size_t kLine = 140;  // characters of the model per line of source: below 300 lines

// The file that is compiled into the program; a text file otherwise.
std::string as_source(const std::string& text) {
  std::string source =
      "// SPDX-License-Identifier: Apache-2.0\n"
      "// Made by `waymark train craters -o pipeline/craters/built_in_model.cpp`; do not edit.\n"
      "// clang-format off\n"
      "#include \"pipeline/craters/crater_model.hpp\"\n\nnamespace waymark {\n\n"
      "const CraterModel& built_in_crater_model() {\n"
      "  static const CraterModel model = parse_crater_model(\n";
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t line = text.find('\n', begin);
    const std::size_t end = std::min(begin + kLine, line == std::string::npos ? text.size() : line);
    const bool ends_line = end == line;
    source += fmt::format("      \"{}{}\"\n", text.substr(begin, end - begin), ends_line ? "\\n" : "");
    begin = ends_line ? end + 1 : end;
  }
  return source + "      , \"the built-in crater model\");\n  return model;\n}\n\n}  // namespace waymark\n";
}

class Train final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "train",
        .group = Group::make,
        .summary = "Train the model that verifies craters",
        .about =
            "Makes scenes with known craters, half of them with the testbed of `waymark simulate`, finds "
            "bowls "
            "in them and learns which are craters and where their rims are. No image that anyone else owns "
            "goes in. The same "
            "scenes and seed give the same model. A name that ends in .cpp gives the source file that "
            "is compiled into waymark.",
        .arguments = {Argument{"", "WHAT", &what_, "What to train"}.needed().one_of({"craters"}),
                      Argument{"-o,--output", "MODEL", &output_, "Model to write, .txt or .cpp"}
                          .needed()
                          .offering(Offer::file),
                      {"--scenes", "N", &scenes_, "Scenes to learn from; each takes about two seconds"},
                      {"--rounds", "N", &rounds_, "Times through all examples"},
                      {"--seed", "N", &seed_, "Another seed gives other first weights and another order"}},
        .examples = {{"waymark train craters -o pipeline/craters/built_in_model.cpp", "The model we ship"},
                     {"waymark train craters -o quick.txt --scenes 20", "A quick one, to try"}}};
  }

  int run(const Session& session) override {
    if (scenes_ < 1 || rounds_ < 1)
      throw Error(ErrorCode::usage, "there must be at least one scene and one round", "",
                  "leave out --scenes and --rounds for the usual");
    const bool source = output_.ends_with(".cpp");
    std::vector<CraterExample> examples;
    for (std::int64_t i = 0; i < scenes_; ++i) {
      // By turns plain shading of relief no testbed makes, and what the testbed renders.
      const auto index = static_cast<std::uint64_t>(i / 2);
      const auto more =
          examples_of(i % 2 == 0 ? shaded_scene(index, kSide) : testbed_lesson(index, kSide), index);
      examples.insert(examples.end(), more.begin(), more.end());
      if ((i + 1) % 20 == 0 && !session.quiet)
        say(fmt::format("{} of {} scenes, {} examples\n", i + 1, scenes_, examples.size()));
    }
    CraterTraining training{.rounds = static_cast<int>(rounds_), .seed = static_cast<std::uint64_t>(seed_)};
    CraterModel model = train_crater_model(examples, training, [&](int round, double loss) {
      if (!session.quiet) say(fmt::format("round {}: loss {:.4f}\n", round + 1, loss));
    });
    model.trained_on =
        fmt::format("made-up and testbed scenes 0 to {}, {} px, {} examples, {} rounds, seed {}", scenes_ - 1,
                    kSide, examples.size(), rounds_, seed_);
    std::ofstream file(output_, std::ios::binary);
    file << (source ? as_source(as_text(model)) : as_text(model));
    file.close();
    if (!file)
      throw Error(ErrorCode::output, "cannot write the model", output_,
                  "check the folder and the space left");
    return 0;
  }

 private:
  static constexpr int kSide = 640;  // pixels
  std::string what_, output_;
  std::int64_t scenes_ = 120, rounds_ = CraterTraining{}.rounds, seed_ = 1;
};

}  // namespace

void register_command_train(CommandTable& commands);
void register_command_train(CommandTable& commands) {
  commands.add<Train>();
}

}  // namespace waymark
