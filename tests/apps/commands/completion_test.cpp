// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsSupersetOf;

/// What bash would offer for the last of these words.
std::vector<std::string> offered(const std::string& words, const std::string& folder = ".") {
  const Outcome said =
      bash("cd " + folder + "; source <($WAYMARK completion bash); COMP_WORDS=(waymark " + words +
           "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _waymark; printf '%s\\n' \"${COMPREPLY[@]}\"");
  EXPECT_EQ(said.code, 0) << said.err;
  std::istringstream lines(said.out);
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  return all;
}

TEST(Completion, IsSoundBash) {
  EXPECT_EQ(bash("$WAYMARK completion bash | bash -n").err, "");
}

TEST(Completion, Commands) {
  EXPECT_THAT(offered("pl"), ElementsAre("plan"));
  EXPECT_THAT(offered("--threads 2 ex"), ElementsAre("export"));
}

TEST(Completion, OptionsOfTheCommandAndOfAll) {
  EXPECT_THAT(offered("query m.gpkg --m"), IsSupersetOf({"--min", "--max", "--min-quality"}));
  EXPECT_THAT(offered("query m.gpkg --thr"), ElementsAre("--threads"));
}

TEST(Completion, Choices) {
  EXPECT_THAT(offered("peaks --nodata f"), ElementsAre("fill"));
  EXPECT_THAT(offered("peaks --nodata = u"), ElementsAre("unknown"));  // bash splits at the equals sign
  EXPECT_THAT(offered("stages find"), Contains("find_mountain_tops"));
  EXPECT_THAT(offered("query m.gpkg --type mount"), ElementsAre("mountain_top"));
}

TEST(Completion, FilesWithBlanksInTheirNames) {
  const TempFolder folder;
  write_text(folder / "my dem.tif", "");
  EXPECT_THAT(offered("peaks my", folder.path()), ElementsAre("my dem.tif"));
}

TEST(Completion, Help) {
  EXPECT_THAT(offered("help pea"), ElementsAre("peaks"));
}

TEST(Completion, IsSoundZsh) {
  const std::string script = waymark({"completion", "zsh"}).out;
  EXPECT_THAT(script, testing::AllOf(testing::StartsWith("#compdef waymark"), testing::HasSubstr("'peaks:"),
                                     testing::HasSubstr("(ocean unknown fill)")));
  if (bash("command -v zsh").code != 0) GTEST_SKIP() << "zsh is not installed";
  EXPECT_EQ(bash("$WAYMARK completion zsh | zsh -n").err, "");
}

TEST(Completion, ZshCompletesWhatIsTyped) {
  if (bash("command -v zsh").code != 0) GTEST_SKIP() << "zsh is not installed";
  const TempFolder folder;
  write_text(folder / "my dem.tif", "");
  write_text(folder / "_waymark", waymark({"completion", "zsh"}).out);
  const auto completed = [&](const std::string& typed) {
    const Outcome said =
        bash(fmt::format("cd '{}' && timeout 60 /usr/bin/python3 '{}/tests/apps/zsh_line.py' '{}'",
                         folder.path().string(), WAYMARK_SOURCE_DIR, typed));
    EXPECT_EQ(said.code, 0) << said.err;
    return said.out;
  };
  EXPECT_EQ(completed("waymark pea"), "waymark peaks ");
  EXPECT_EQ(completed("waymark --threads 2 ex"), "waymark --threads 2 export ");
  EXPECT_EQ(completed("waymark peaks --nod"), "waymark peaks --nodata ");
  EXPECT_EQ(completed("waymark peaks --nodata f"), "waymark peaks --nodata fill ");
  EXPECT_EQ(completed("waymark peaks my"), "waymark peaks my\\ dem.tif ");
  EXPECT_EQ(completed("waymark query m.gpkg --type mount"), "waymark query m.gpkg --type mountain_top ");
}

TEST(Completion, IsSoundFish) {
  const std::string script = waymark({"completion", "fish"}).out;
  EXPECT_THAT(script, testing::HasSubstr("-n '__waymark_command_is peaks' -l nodata"));
  if (bash("command -v fish").code != 0) GTEST_SKIP() << "fish is not installed";
  const auto offered_by_fish = [](const std::string& typed) {
    return bash("fish -c '$WAYMARK completion fish | source; complete -C \"" + typed + "\"'").out;
  };
  EXPECT_THAT(offered_by_fish("waymark pea"), testing::StartsWith("peaks\t"));
  EXPECT_THAT(offered_by_fish("waymark --threads 2 ex"), testing::StartsWith("export\t"));
  EXPECT_THAT(offered_by_fish("waymark --threads 2 peaks --nodata f"), testing::StartsWith("fill\t"));
  EXPECT_EQ(offered_by_fish("waymark query export --nodat"), "");  // a map of that name is no command
}

TEST(ManPage, HasEveryCommandAndGroffIsContent) {
  const std::string page = waymark({"man"}).out;
  for (const char* part : {".TH WAYMARK 1", ".SS peaks", ".SS query", ".SH EXIT STATUS"})
    EXPECT_THAT(page, testing::HasSubstr(part));
  if (bash("command -v groff").code != 0) GTEST_SKIP() << "groff is not installed";
  EXPECT_EQ(bash("$WAYMARK man | groff -man -ww -z").err, "");
}

}  // namespace
}  // namespace waymark::test
