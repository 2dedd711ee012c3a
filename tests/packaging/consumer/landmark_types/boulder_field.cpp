// SPDX-License-Identifier: Apache-2.0
#include <waymark/waymark.hpp>
namespace consumer {
using namespace waymark;

void register_type_boulder_field(TypeRegistry& types);
void register_type_boulder_field(TypeRegistry& types) {
  types.add({.name = "boulder_field",
             .summary = "Ground strewn with blocks: rough, and slow to drive",
             .features = {{"area", "m2", Scale::ratio, 1, 1e9, "Ground covered"}}});
}

}  // namespace consumer
