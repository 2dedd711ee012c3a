// SPDX-License-Identifier: Apache-2.0
#include "geo/proj_version.hpp"

#include <proj.h>

namespace waymark::inline geo {

std::string proj_version() {
  return proj_info().version;
}

}  // namespace waymark::inline geo
