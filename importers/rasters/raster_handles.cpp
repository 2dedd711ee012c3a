// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/raster_handles.hpp"

#include <algorithm>

namespace waymark::importers {

GdalDataset RasterHandles::take(std::size_t file) {
  {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::find(idle_, file, &Idle::file);
    if (found != idle_.end()) {
      GdalDataset dataset = std::move(found->dataset);
      idle_.erase(found);
      return dataset;
    }
  }
  return open_raster(paths_[file]);
}

void RasterHandles::give_back(std::size_t file, GdalDataset dataset) {
  std::list<Idle> closing;  // outside the lock
  const std::scoped_lock lock(mutex_);
  idle_.push_front({file, std::move(dataset)});
  if (idle_.size() > kIdle) closing.splice(closing.begin(), idle_, std::prev(idle_.end()));
}

}  // namespace waymark::importers
