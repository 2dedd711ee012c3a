// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/bucket_file.hpp"

#include <algorithm>
#include <utility>

namespace waymark::pipeline {

BucketFile::BucketFile(std::shared_ptr<ScratchFile> file, std::size_t buckets, std::size_t buffered)
    : file_(std::move(file)),
      buckets_(buckets),
      piece_(std::clamp<std::size_t>(buffered / std::max<std::size_t>(buckets, 1), 4096, 1 << 20)) {}

void BucketFile::add(std::size_t number, std::string_view bytes) {
  Bucket& bucket = buckets_[number];
  bucket.buffer += bytes;
  if (bucket.buffer.size() >= piece_)
    bucket.pieces.push_back(file_->put(std::exchange(bucket.buffer, std::string())));
}

std::string BucketFile::read(std::size_t number) const {
  std::string bytes;
  for (const auto& piece : buckets_[number].pieces) bytes += piece();
  return bytes + buckets_[number].buffer;
}

}  // namespace waymark::pipeline
