// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/apps/program.hpp"
namespace waymark::test {

// Two houses of a row, a lamp, a tree, a garage whose outline is not closed, a way without tags.
inline constexpr const char* kTown = R"(<?xml version='1.0' encoding='UTF-8'?>
<osm version='0.6'>
 <node id='1' lat='49.0000000' lon='8.4000000'/> <node id='2' lat='49.0000000' lon='8.4001367'/>
 <node id='3' lat='49.0000900' lon='8.4001367'/> <node id='4' lat='49.0000900' lon='8.4000000'/>
 <node id='5' lat='49.0000000' lon='8.4002734'/> <node id='6' lat='49.0000900' lon='8.4002734'/>
 <node id='7' lat='49.0010000' lon='8.4000000'><tag k='highway' v='street_lamp'/><tag k='height' v='6 m'/></node>
 <node id='8' lat='49.0020000' lon='8.4010000'><tag k='natural' v='tree'/><tag k='height' v='tall'/>
  <tag k='circumference' v='1,57'/></node>
 <way id='20'><nd ref='1'/><nd ref='2'/><nd ref='3'/><nd ref='4'/><nd ref='1'/><tag k='building' v='yes'/></way>
 <way id='21'><nd ref='2'/><nd ref='5'/><nd ref='6'/><nd ref='3'/><nd ref='2'/><tag k='building' v='house'/></way>
 <way id='22'><nd ref='7'/><nd ref='8'/><nd ref='6'/><tag k='building' v='garage'/></way>
 <way id='23'><nd ref='7'/><nd ref='8'/></way>
</osm>
)";

/// The program on files of GIS written here.
class ImportRules : public ::testing::Test {
 protected:
  Outcome import(const std::string& text, const std::string& name, std::vector<std::string> words) {
    write_text(folder_.path() / name, text);
    words.insert(words.begin(), {"import", folder_ / name, "-o", map_});
    return waymark(words);
  }
  std::string rules(const std::string& text) {
    write_text(folder_.path() / "rules.json", R"({"waymark_rules": 1, "rules": [)" + text + "]}");
    return folder_ / "rules.json";
  }
  nlohmann::json landmarks(const std::string& type) {
    const Outcome said = waymark({"query", map_, "--type", type, "--format", "json"});
    return said.code == 0 ? nlohmann::json::parse(said.out) : nlohmann::json::array();
  }

  TempFolder folder_;
  std::string map_ = folder_ / "map.gpkg";
};

}  // namespace waymark::test
