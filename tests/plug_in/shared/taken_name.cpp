// SPDX-License-Identifier: Apache-2.0
#include <waymark/plug_in.hpp>

void waymark_plug_in(waymark::workflows::PlugIn& to) {
  to.types.add({.name = "new_type", .summary = "Not to be seen", .features = {}});
  to.types.add({.name = "rock", .summary = "Another rock", .features = {}});
}
