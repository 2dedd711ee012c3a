// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "made_dem.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(CommandLine, NoCommandIsWrongUsageAndShowsTheCommands) {
  const Outcome said = waymark({});
  EXPECT_EQ(said.code, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_THAT(said.err, HasSubstr("Usage: waymark COMMAND"));
}

TEST(CommandLine, HelpGoesToStandardOutputAndListsEveryCommand) {
  const Outcome said = waymark({"--help"});
  EXPECT_EQ(said.code, 0);
  EXPECT_EQ(said.err, "");
  for (const char* command : {"completion", "export", "man", "peaks", "plan", "query", "report", "run",
                              "sensors", "stages", "types", "validate"})
    EXPECT_THAT(said.out, HasSubstr("\n  " + std::string(command) + " "));
  EXPECT_THAT(said.out, HasSubstr("Exit codes:"));
}

TEST(CommandLine, HelpOfACommandHasUsageOptionsAndExamples) {
  for (const auto& words : {std::vector<std::string>{"query", "--help"}, {"query", "-h"}, {"-h", "query"}}) {
    const Outcome said = waymark(words);
    EXPECT_EQ(said.code, 0);
    EXPECT_THAT(said.out, StartsWith("Usage: waymark query MAP.gpkg [options]\n"));
    EXPECT_THAT(said.out,
                AllOf(HasSubstr("--near X Y RADIUS"), HasSubstr("Examples:"), HasSubstr("--threads N")));
  }
}

TEST(CommandLine, DeclarationsAreJsonForPrograms) {
  const auto all = nlohmann::json::parse(waymark({"help", "--format", "json"}).out);
  EXPECT_THAT(all["version"].get<std::string>(), StartsWith("waymark "));
  std::set<std::string> names;
  for (const auto& command : all["commands"]) names.insert(command["name"]);
  EXPECT_TRUE(names.contains("peaks") && names.contains("web") && names.contains("help"));
  const auto query = nlohmann::json::parse(waymark({"help", "query", "--format", "json"}).out)["commands"][0];
  std::map<std::string, nlohmann::json> arguments;
  for (const auto& argument : query["arguments"])
    arguments[argument["names"].empty() ? argument["value"] : argument["names"][0]] = argument;
  EXPECT_EQ(arguments.at("MAP.gpkg")["offer"], "file");
  EXPECT_EQ(arguments.at("MAP.gpkg")["required"], true);
  EXPECT_EQ(arguments.at("--near")["kind"], "numbers");
  EXPECT_EQ(arguments.at("--near")["value"], "X Y RADIUS");
  EXPECT_EQ(arguments.at("--limit")["kind"], "integer");
  EXPECT_THAT(arguments.at("--format")["choices"], testing::Contains("geojson"));
}

TEST(CommandLine, VersionIsTheFirstLineAndTheBuildFollows) {
  const Outcome said = waymark({"--version"});
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.out, testing::MatchesRegex("waymark [0-9.]+\n(  [a-z0-9]+ +[^\n]+\n)+"));
  for (const char* name :
       {"compiler", "gdal", "geos", "proj", "sqlite", "libpq", "opencv", "ceres", "tbb", "zstd", "lz4"})
    EXPECT_THAT(said.out, HasSubstr("\n  " + std::string(name) + " "));
}

TEST(CommandLine, VersionIsAlsoJson) {
  const Outcome said = waymark({"-V", "--format", "json"});
  EXPECT_EQ(said.code, 0);
  const auto build = nlohmann::json::parse(said.out);
  EXPECT_THAT(waymark({"-V"}).out, StartsWith("waymark " + build["version"].get<std::string>() + "\n"));
  const Outcome gdal = bash("gdalinfo --version");
  if (gdal.code == 0) {
    EXPECT_THAT(gdal.out, StartsWith("GDAL " + build["libraries"]["gdal"].get<std::string>() + ","));
  }
  for (const char* name : {"proj", "sqlite", "libpq", "opencv", "ceres", "tbb"})
    EXPECT_THAT(build["libraries"][name].get<std::string>(), testing::MatchesRegex("[0-9]+[.][0-9.]+"))
        << name;
  EXPECT_TRUE(build["decompressors"]["zstd"].is_boolean());
  EXPECT_FALSE(build["compiler"].get<std::string>().empty() || build["processor"].get<std::string>().empty());
  EXPECT_EQ(waymark({"-V", "--format", "xml"}).code, 2);
  EXPECT_EQ(waymark({"-V", "--fromat", "json"}).code, 2);
}

TEST(CommandLine, VersionHasAShortName) {
  EXPECT_EQ(waymark({"-V"}).out, waymark({"--version"}).out);
}

TEST(CommandLine, HelpIsACommandToo) {
  EXPECT_EQ(waymark({"help", "peaks"}).out, waymark({"peaks", "--help"}).out);
  EXPECT_EQ(waymark({"help"}).out, waymark({"--help"}).out);
  EXPECT_THAT(waymark({"help", "peeks"}).err, HasSubstr("did you mean 'peaks'?"));
}

TEST(CommandLine, NoColorIsRespected) {
  if (bash("command -v script").code != 0) GTEST_SKIP() << "script is not installed";
  const auto on_a_terminal = [](const std::string& before) {
    return bash(before + " script -qec '$WAYMARK nonsense' /dev/null < /dev/null").out;
  };
  EXPECT_THAT(on_a_terminal("TERM=xterm NO_COLOR="), HasSubstr("\x1b["));
  EXPECT_THAT(on_a_terminal("TERM=xterm NO_COLOR=1"),
              testing::AllOf(HasSubstr("error: "), testing::Not(HasSubstr("\x1b["))));
}

TEST(CommandLine, UnknownCommandNamesTheNearest) {
  const Outcome said = waymark({"pekas", "dem.tif"});
  EXPECT_EQ(said.code, 2);
  EXPECT_EQ(said.err, "error: waymark has no command 'pekas'\n  did you mean 'peaks'?\n");
}

TEST(CommandLine, UnknownOptionNamesTheNearest) {
  EXPECT_EQ(waymark({"query", "map.gpkg", "--tpye", "rock"}).err,
            "error: waymark query has no option '--tpye'\n  did you mean '--type'?\n");
  EXPECT_EQ(waymark({"peaks", "dem.tif", "--min-prominense=30"}).err,
            "error: waymark peaks has no option '--min-prominense'\n  did you mean '--min-prominence'?\n");
  EXPECT_EQ(waymark({"--verson"}).err,
            "error: waymark has no option '--verson'\n  did you mean '--version'?\n");
}

TEST(CommandLine, AWordTooManyIsNamed) {
  const Outcome said = waymark({"validate", "a.gpkg", "b.gpkg"});
  EXPECT_EQ(said.code, 2);
  EXPECT_EQ(said.err,
            "error: waymark validate has no use for the word 'b.gpkg'\n  `waymark validate --help` shows "
            "what it takes\n");
}

TEST(CommandLine, HelpFitsTheColumnsOfTheEnvironment) {
  const auto longest = [](const std::string& columns) {
    const Outcome said = bash(columns + " $WAYMARK localize --help");
    std::istringstream lines(said.out.substr(0, said.out.find("Examples:")));
    std::size_t most = 0;
    for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
    return most;
  };
  EXPECT_LE(longest("COLUMNS=80"), 80u);
  EXPECT_GT(longest("COLUMNS=80"), 70u);
  EXPECT_LT(longest("COLUMNS=7"), 70u);  // 60, but for a long word
  EXPECT_GT(longest("COLUMNS=none"), 90u);
}

TEST(CommandLine, AMissingArgumentIsNamed) {
  EXPECT_THAT(waymark({"query"}).err, StartsWith("error: waymark query needs MAP.gpkg\n"));
  EXPECT_THAT(waymark({"report", "map.gpkg"}).err,
              StartsWith("error: waymark report needs -o REPORT.html\n"));
  EXPECT_THAT(waymark({"peaks", "dem.tif"}).err, StartsWith("error: the map needs a name: -o MAP.gpkg\n"));
}

TEST(CommandLine, ValuesAreChecked) {
  EXPECT_EQ(waymark({"query", "m.gpkg", "--limit", "ten"}).err,
            "error: --limit must be a whole number, is 'ten'\n");
  EXPECT_EQ(waymark({"query", "m.gpkg", "--near", "8", "46", "nan"}).err,
            "error: --near must be a number, is 'nan'\n");
  EXPECT_EQ(waymark({"query", "m.gpkg", "--bbox", "1", "2", "3"}).err,
            "error: --bbox takes 4 values (X0 Y0 X1 Y1), has 3\n");
  EXPECT_EQ(waymark({"query", "m.gpkg", "--format", "cvs"}).err,
            "error: --format must be one of table, csv, json, geojson, is 'cvs'\n  did you mean 'csv'?\n");
  EXPECT_EQ(waymark({"peaks", "dem.tif", "-o", "m.gpkg", "--nodata", "fil"}).err,
            "error: --nodata must be one of ocean, unknown, fill, is 'fil'\n  did you mean 'fill'?\n");
  EXPECT_THAT(waymark({"peaks", "dem.tif", "-o", "m.gpkg", "--min-prominence", "high"}).err,
              StartsWith("error: --min-prominence must be a number, is a string (\"high\")\n"));
  EXPECT_THAT(waymark({"peaks", "dem.tif", "-o", "m.gpkg", "--tile-cells", "5"}).err,
              StartsWith("error: --tile-cells = 5 is outside [64, 16384]\n"));
  EXPECT_THAT(waymark({"--threads", "-2", "types"}).err, StartsWith("error: --threads must be 1 or more"));
  EXPECT_THAT(waymark({"types", "--config", "CACHE"}).err,
              StartsWith("error: --config takes KEY=VALUE, is 'CACHE'\n"));
}

TEST(CommandLine, FormerNamesOfOptionsAreReadWithAWarning) {
  EXPECT_THAT(waymark({"allometry", "fit", "none.csv", "-o", "t.csv", "--least-trees=3"}).err,
              StartsWith("warning: --least-trees was renamed: use --min-trees\nerror: "));
  EXPECT_THAT(waymark({"evaluate", "landmarks", "none.csv", "--truth", "none.csv", "--share", "2"}).err,
              StartsWith("warning: --share was renamed: use --tolerance\nerror: "));
  EXPECT_THAT(waymark({"allometry", "--help"}).out, HasSubstr("(formerly --least-trees)"));
}

TEST(CommandLine, FilesMayBeListedInAFile) {
  const TempFolder folder;
  const std::string left = make_dem(folder / "left.tif", twin_peaks()), map = folder / "map.gpkg";
  MadeDem east = twin_peaks();
  east.geotransform[0] += 7000;
  const std::string right = make_dem(folder / "right.tif", east);
  write_text(folder / "list.txt", left + "\r\n\n" + right);
  const auto job_of = [](const std::vector<std::string>& files) {
    std::vector<std::string> words{"peaks", "--print-job"};
    words.insert(words.end(), files.begin(), files.end());
    return waymark(words);
  };
  EXPECT_EQ(job_of({"@" + (folder / "list.txt")}).out, job_of({left, right}).out);
  EXPECT_THAT(waymark({"peaks", "--help"}).out, HasSubstr("@FILE"));
  const Outcome none = job_of({"@" + (folder / "none.txt")});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("cannot read the list of files"));
  write_text(folder / "empty.txt", "\n");
  EXPECT_THAT(job_of({"@" + (folder / "empty.txt")}).err, HasSubstr("the list of files is empty"));
  // A line is a file, whatever it looks like, and does not permit the network.
  write_text(folder / "hostile.txt", "--plugin=x.so\n");
  EXPECT_THAT(waymark({"peaks", "@" + (folder / "hostile.txt"), "-o", map}).err, HasSubstr("--plugin=x.so"));
  write_text(folder / "remote.txt", "/vsicurl/http://127.0.0.1:9/a.tif\n");
  EXPECT_THAT(waymark({"peaks", "@" + (folder / "remote.txt"), "-o", map}).err, HasSubstr("--allow-network"));
}

TEST(CommandLine, GlobalOptionsStandBeforeOrAfterTheCommand) {
  EXPECT_EQ(waymark({"--threads", "2", "types"}).code, 0);
  EXPECT_EQ(waymark({"types", "--threads=2", "-q"}).code, 0);
}

TEST(CommandLine, AFullStandardOutputIsAnError) {
  const Outcome said = bash("$WAYMARK man > /dev/full");
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.err, StartsWith("error: cannot write to standard output\n"));
}

TEST(Describe, EverythingHasItsFourForms) {
  for (const std::string kind : {"stages", "types", "sensors", "detectors"})
    for (const std::string form : {"text", "json", "schema", "markdown"}) {
      const Outcome said = waymark({kind, "--as", form});
      EXPECT_EQ(said.code, 0) << kind << " " << form << ": " << said.err;
      EXPECT_FALSE(said.out.empty());
    }
}

TEST(Describe, ADetectorSaysWhatItReadsAndMakes) {
  const auto walls = nlohmann::json::parse(waymark({"detectors", "walls", "--format", "json"}).out);
  EXPECT_EQ(walls["record"], "laser");
  EXPECT_THAT(walls["types"], testing::Contains("wall_corner"));
  EXPECT_THAT(waymark({"detectors", "rocks"}).out, HasSubstr("scans=rocks"));
  const auto schema = nlohmann::json::parse(waymark({"detectors", "rocks", "--format", "schema"}).out);
  EXPECT_EQ(schema["properties"]["scans"]["default"], "rocks");
  const Outcome unknown = waymark({"detectors", "rock"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'rocks'?"));
}

TEST(Describe, FormatHasASecondNameThatHelpDoesNotList) {
  EXPECT_EQ(waymark({"types", "rock", "--as", "json"}).out,
            waymark({"types", "rock", "--format", "json"}).out);
  EXPECT_EQ(waymark({"types", "rock", "--as", "json"}).err, "");
  const std::string help = waymark({"types", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("--format FORMAT"));
  EXPECT_THAT(help, Not(HasSubstr("--as")));
}

TEST(Describe, OneByNameOrTheNearest) {
  EXPECT_THAT(waymark({"types", "rock"}).out, HasSubstr("Half the mean width"));
  EXPECT_THAT(waymark({"stages", "find_mountain_tops"}).out, HasSubstr("min_prominence"));
  EXPECT_EQ(waymark({"types", "rok"}).err,
            "error: there is no landmark type 'rok'\n  did you mean 'rock'?\n");
  EXPECT_EQ(waymark({"types", "rok"}).code, 2);
}

}  // namespace
}  // namespace waymark::test
