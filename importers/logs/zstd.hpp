// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
namespace waymark::importers {

/// Returns whether bytes begin like a frame of Zstandard (RFC 8878). A message in CDR and an SQLite file
/// never do.
bool is_zstd(std::string_view bytes);

/// Returns the content of a frame of Zstandard, as GDAL decompresses it. Its size is that of the frame, which
/// may need a pass over the content, unless `stated_size` is given. Throws std::runtime_error if the frame is
/// damaged, empty, larger than `stated_size`, or states more content than it can hold.
std::string unpacked_zstd(std::string_view bytes, std::optional<std::uint64_t> stated_size = {});

}  // namespace waymark::importers
