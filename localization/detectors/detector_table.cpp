// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/detector_table.hpp"

#include <algorithm>
#include <stdexcept>

namespace waymark::localization {

void DetectorTable::add(DetectorSpec detector) {
  if (detector.name.empty() || find(detector.name))
    throw std::logic_error("a detector has no name, or two are named '" + detector.name + "'");
  const bool makes = detector.record == "laser"    ? bool(detector.make)
                     : detector.record == "points" ? bool(detector.make_points)
                                                   : false;
  if (!makes || detector.types.empty())
    throw std::logic_error("detector " + detector.name + " declares no record, types or function");
  detectors_.push_back(std::move(detector));
}

const DetectorSpec* DetectorTable::find(std::string_view name) const {
  const auto found = std::ranges::find(detectors_, name, &DetectorSpec::name);
  return found == detectors_.end() ? nullptr : &*found;
}

std::vector<std::string> DetectorTable::names() const {
  std::vector<std::string> all;
  for (const DetectorSpec& detector : detectors_) all.push_back(detector.name);
  return all;
}

std::optional<TypeId> type_in_map(const TypeRegistry& types, std::string_view name) {
  return types.find(name) ? std::optional<TypeId>(types.id(name)) : std::nullopt;
}

}  // namespace waymark::localization
