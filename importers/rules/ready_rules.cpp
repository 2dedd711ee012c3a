// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/ready_rules.hpp"

namespace waymark::importers {

const ReadyRules& ready_rules() {
  static const ReadyRules rules = [] {
    ReadyRules made;
    register_ready_rules(made);
    return made;
  }();
  return rules;
}

}  // namespace waymark::importers
