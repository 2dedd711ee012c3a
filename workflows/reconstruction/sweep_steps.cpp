// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/sweep_steps.hpp"

#include "core/byte_layout.hpp"
#include "importers/hash.hpp"
#include "pipeline/engine/sha256.hpp"
#include "pipeline/reconstruction/reconstruction_codec.hpp"

namespace waymark::workflows {
namespace {

std::string key_of_view(const pipeline::SurfaceView& view) {
  ByteWriter key;
  ByteLayout<ByteWriter> io(key);
  const Camera& camera = view.view.camera;
  io(view.name, importers::hash_file(view.image->info().path).sha256);
  io(camera.columns, camera.rows, camera.fx, camera.fy, camera.cx, camera.cy, camera.skew, camera.lens,
     camera.distortion);
  io.matrix(view.view.grid_from_camera.transform.matrix());
  io.maybe(view.view.motion, [&](const ShutterMotion& m) { io.matrix(m.shift), io.matrix(m.turn); });
  io.maybe(view.sun, [&](const Sun& sun) { io(sun.azimuth.value, sun.elevation.value); });
  return key.take();
}

void layout_grid(ByteLayout<ByteWriter>& io, const pipeline::SurfaceGrid& grid) {
  io(grid.west, grid.north, grid.cell, grid.columns, grid.rows);
}

// The rules are constants of the program: a change of them raises the version of the step.
std::string key_of_plan(const pipeline::SweepPlan& plan) {
  ByteWriter key;
  ByteLayout<ByteWriter> io(key);
  layout_grid(io, plan.grid);
  io(plan.range.low, plan.range.high, plan.levels);
  io.maybe(plan.coarse, [&](const pipeline::CoarseHeights& coarse) {
    layout_grid(io, coarse.grid);
    io(coarse.sd);
    io.list(coarse.heights.cells(), [&](float height) { io(height); });
  });
  return key.take();
}

}  // namespace

void keep_chunks(pipeline::SweepPlan& plan, const std::vector<pipeline::SurfaceView>& views,
                 const pipeline::KeptResults& kept) {
  if (!kept.enabled()) return;
  pipeline::Sha256 key;
  key.add(key_of_plan(plan));
  for (const pipeline::SurfaceView& view : views) key.add(key_of_view(view));
  plan.keep = [&kept, depends_on = key.hex()](const std::string& item,
                                              const std::function<pipeline::ChunkHeights()>& compute) {
    return kept.get<pipeline::ChunkHeights>(
        {.name = "sweep_heights", .item = item, .version = 3, .depends_on = depends_on}, compute);
  };
}

}  // namespace waymark::workflows
