// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include "pipeline/engine/pipeline.hpp"
namespace waymark::workflows {

/// Returns whether a path is a place on the network: an address with ://, a file system of GDAL such as
/// /vsicurl/, also within another, or a database or service of GDAL such as PG: or WMS:.
bool is_on_network(const std::string& path);

/// Returns whether one of the words that a user typed is on the network, alone or after an equals sign.
bool names_network(std::span<const std::string> words);

/// Lets GDAL open nothing on the network, whatever a file names (a VRT, for example). Call it before the
/// first file is opened.
void refuse_network();

/// Throws Error{usage} if an option of a stage names a file outside the folder of the job, or a place on the
/// network: the author of the job may not be the person who runs it. Symbolic links are followed.
void require_files_inside(const pipeline::Pipeline& pipeline, const std::filesystem::path& job);

}  // namespace waymark::workflows
