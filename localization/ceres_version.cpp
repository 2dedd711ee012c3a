// SPDX-License-Identifier: Apache-2.0
#include "localization/ceres_version.hpp"

#include <ceres/version.h>

namespace waymark::localization {

std::string ceres_version() {
  return CERES_VERSION_STRING;
}

}  // namespace waymark::localization
