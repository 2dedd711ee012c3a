// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "testbed/scenario.hpp"
namespace waymark::testbed {

/// Section of a scenario; its fields are declared once for reader, writer and schema.
struct ScenarioSection {
  std::string name;  ///< empty: top-level fields
  std::string help;
  std::function<void(Scenario&, OptionVisitor&)> describe;
};

/// Returns the sections in the order of the file, without flights.
const std::vector<ScenarioSection>& scenario_sections();
void describe_forest(Scenario& scenario, OptionVisitor& field);
void describe_street(Scenario& scenario, OptionVisitor& field);
void describe_hall(Scenario& scenario, OptionVisitor& field);
void describe_flight(Flight& flight, OptionVisitor& field);

}  // namespace waymark::testbed
