// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace waymark::pipeline {
namespace {

template <class Ports>
void expect_declared(const StageSpec& spec, const Ports& ports, std::string_view name, std::type_index type,
                     const char* verb) {
  const auto port = std::ranges::find(ports, name, [](const auto& p) { return std::string_view(p.name); });
  if (port == ports.end())
    throw std::logic_error(fmt::format("stage {} {} '{}', which it has not declared", spec.name, verb, name));
  if (port->type != type)
    throw std::logic_error(fmt::format("stage {} {} '{}' as {}, but declares {}", spec.name, verb, name,
                                       readable_type(type), readable_type(port->type)));
}

}  // namespace

std::int64_t Counts::rejected_total() const {
  std::int64_t total = 0;
  for (const auto& [reason, n] : rejected) total += n;
  return total;
}

Counts& Counts::operator+=(const Counts& other) {
  in += other.in;
  out += other.out;
  for (const auto& [reason, n] : other.rejected) rejected[reason] += n;
  return *this;
}

const PortInput& StageContext::declared_input(std::string_view port, std::type_index type) const {
  expect_declared(spec_, spec_.inputs, port, type, "reads");
  return inputs_.ports.find(port)->second;
}

const ArtifactPtr& StageContext::only_item(std::string_view port, std::type_index type) const {
  const PortInput& input = declared_input(port, type);
  if (input.many)
    throw std::logic_error(
        fmt::format("stage {} reads '{}' with read, but there are many: use read_all", spec_.name, port));
  return input.items.front();
}

Artifact::Value StageContext::read_one(std::string_view port, std::type_index type) {
  const ArtifactPtr& item = only_item(port, type);
  const std::lock_guard lock(mutex_);
  return read_.try_emplace(item.get(), item->value()).first->second;
}

std::vector<Artifact::Value> StageContext::read_each(std::string_view port, std::type_index type) {
  std::vector<Artifact::Value> values;
  for (const ArtifactPtr& item : declared_input(port, type).items) values.push_back(item->value());
  return values;
}

Artifact::Value StageContext::take_one(std::string_view port, std::type_index type) {
  const ArtifactPtr& item = only_item(port, type);
  return item.use_count() > 1 ? item->value() : item->take();  // shared while another unit needs it
}

std::vector<Artifact::Value> StageContext::take_each(std::string_view port, std::type_index type) {
  std::vector<Artifact::Value> values;
  for (const ArtifactPtr& item : declared_input(port, type).items)
    values.push_back(item.use_count() > 1 ? item->value() : item->take());
  return values;
}

void StageContext::write_one(std::string_view port, std::type_index type, Artifact::Value value) {
  expect_declared(spec_, spec_.outputs, port, type, "writes");
  const std::lock_guard lock(mutex_);
  if (!outcome_.outputs.emplace(port, std::move(value)).second)
    throw std::logic_error(fmt::format("stage {} writes '{}' twice", spec_.name, port));
}

const Tile& StageContext::tile() const {
  if (!inputs_.tile)
    throw std::logic_error(
        fmt::format("stage {} has {} scope: it has no tile", spec_.name, to_string(spec_.scope)));
  return *inputs_.tile;
}

const ImageItem& StageContext::image() const {
  if (!inputs_.image)
    throw std::logic_error(
        fmt::format("stage {} has {} scope: it has no image", spec_.name, to_string(spec_.scope)));
  return *inputs_.image;
}

const TypeRegistry& StageContext::types() const {
  if (!inputs_.types) throw std::logic_error(fmt::format("stage {} has no landmark types", spec_.name));
  return *inputs_.types;
}

Window StageContext::cells_with_halo() const {
  return expand(tile().cells, spec_.halo);
}

std::string StageContext::path(const std::string& option) const {
  return resolve_path(inputs_.base_folder, option);
}

std::shared_ptr<ScratchFile> StageContext::make_scratch_file(std::size_t in_memory) const {
  return std::make_shared<ScratchFile>(inputs_.scratch, in_memory);
}

void StageContext::count_in(std::int64_t n) {
  const std::lock_guard lock(mutex_);
  outcome_.counts.in += n;
  counts_input_ = true;
}

void StageContext::count_out(std::int64_t n) {
  const std::lock_guard lock(mutex_);
  outcome_.counts.out += n;
}

void StageContext::reject(std::string_view reason, std::int64_t n) {
  const std::lock_guard lock(mutex_);
  if (n != 0) outcome_.counts.rejected[std::string(reason)] += n;
  counts_input_ = true;
}

void StageContext::warn(std::string text) {
  const std::lock_guard lock(mutex_);
  outcome_.warnings.push_back(std::move(text));
}

void StageContext::progress(double done_fraction) const {
  if (inputs_.progress) inputs_.progress(std::clamp(done_fraction, 0.0, 1.0));
}

UnitOutcome StageContext::finish() {
  for (const OutputPort& port : spec_.outputs)
    if (!outcome_.outputs.contains(port.name))
      throw std::logic_error(fmt::format("stage {} did not write '{}'", spec_.name, port.name));
  const Counts& counts = outcome_.counts;
  if (counts_input_ && counts.in != counts.out + counts.rejected_total())
    throw std::logic_error(fmt::format("stage {} lost count in {}: {} in, {} out, {} rejected", spec_.name,
                                       inputs_.id, counts.in, counts.out, counts.rejected_total()));
  return std::move(outcome_);
}

std::string resolve_path(const std::filesystem::path& folder, const std::string& text) {
  const bool gdal_name = text.substr(0, text.find('/')).find(':') != std::string::npos;
  return gdal_name || folder.empty() ? text : (folder / text).string();
}

}  // namespace waymark::pipeline
