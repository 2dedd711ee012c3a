// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <vector>
#include "importers/gdal_session.hpp"
namespace waymark::importers {

/// Pool of open files. Lends each to one thread at a time, since a GDAL data set may not be shared. Opens
/// files on demand and keeps the `kIdle` most recently used idle ones open.
class RasterHandles {
 public:
  static constexpr std::size_t kIdle = 64;

  explicit RasterHandles(std::vector<std::string> paths) : paths_(std::move(paths)) {}

  /// Borrows a file and returns it to the pool when destroyed.
  class Lease {
   public:
    Lease(RasterHandles& pool, std::size_t file) : pool_(&pool), file_(file), dataset_(pool.take(file)) {}
    ~Lease() { pool_->give_back(file_, std::move(dataset_)); }
    Lease(const Lease&) = delete;
    GDALDataset& operator*() const { return *dataset_; }

   private:
    RasterHandles* pool_;
    std::size_t file_;
    GdalDataset dataset_;
  };

 private:
  struct Idle {
    std::size_t file;
    GdalDataset dataset;
  };

  GdalDataset take(std::size_t file);
  void give_back(std::size_t file, GdalDataset dataset);

  std::vector<std::string> paths_;
  std::mutex mutex_;
  std::list<Idle> idle_;  // most recently used first
};

}  // namespace waymark::importers
