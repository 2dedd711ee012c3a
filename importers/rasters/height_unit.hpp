// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark {

struct HeightUnit {
  double metres = 1;
  bool known = true;
};

/// The unit of a band by any name in use, whatever its case. No name means metres.
HeightUnit height_unit(std::string_view name);

}  // namespace waymark
