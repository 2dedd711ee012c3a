// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "testbed/scenario.hpp"
namespace waymark {

/// A part of a scenario file: its fields, declared once for reader, writer and schema.
struct ScenarioSection {
  std::string name;  ///< empty: fields of the file itself
  std::string help;
  std::function<void(Scenario&, OptionVisitor&)> describe;
};

/// In the order of the file; flights are apart.
const std::vector<ScenarioSection>& scenario_sections();
void describe_forest(Scenario& scenario, OptionVisitor& field);
void describe_flight(Flight& flight, OptionVisitor& field);

}  // namespace waymark
