// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "exporters/view/view_scene.hpp"
namespace waymark::exporters {

/// Returns a page that draws a scene with WebGL 2. It needs no network and no other file. Its policy allows
/// the page's own script only, by hash; everything else in it is data. The same scene gives the same bytes.
std::string view_page(const ViewScene& scene);

}  // namespace waymark::exporters
