// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/image_view_codec.hpp"

#include "core/bytes.hpp"

namespace waymark::pipeline {
namespace {

// Each layout is defined once for both directions: `io` is a ByteWriter or a ByteReader.
void layout(auto& io, auto& matrix) requires requires {
  matrix.reshaped();
}
{
  for (auto& v : matrix.reshaped()) io(v);
}

void layout(auto& io, auto& camera) requires requires {
  camera.distortion;
}
{
  io(camera.columns), io(camera.rows), io(camera.fx), io(camera.fy), io(camera.cx), io(camera.cy);
  io(camera.skew), io(camera.lens);
  for (auto& k : camera.distortion) io(k);
}

void layout(auto& io, auto& view) requires requires {
  view.grid_from_camera;
}
{
  layout(io, view.camera);
  layout(io, view.grid_from_camera.transform.matrix());
  layout(io, view.covariance);
}

void layout(auto& io, auto& motion) requires requires {
  motion.turn;
}
{ layout(io, motion.shift), layout(io, motion.turn); }

void layout(auto& io, auto& ortho) requires requires {
  ortho.step_x;
}
{ io(ortho.x0), io(ortho.y0), io(ortho.step_x), io(ortho.step_y); }

void layout(auto& io, auto& sun) requires requires {
  sun.azimuth;
}
{ io(sun.azimuth), io(sun.elevation), io(sun.sd); }

void layout(auto& io, auto& tie) requires requires {
  tie.information_vector;
}
{ layout(io, tie.information), layout(io, tie.information_vector); }

void layout(auto& io, auto& shift) requires requires {
  shift.stated;
}
{ layout(io, shift.metres), layout(io, shift.covariance), layout(io, shift.stated), io(shift.cell); }

template <class T>
void write_optional(ByteWriter& out, const std::optional<T>& value) {
  out(value.has_value());
  if (value) layout(out, *value);
}
template <class T>
void read_optional(ByteReader& in, std::optional<T>& value) {
  if (in.get<bool>()) layout(in, value.emplace());
}

void write(ByteWriter& out, const ImageView& image) {
  out(image.name), out(image.columns), out(image.rows);
  write_optional(out, image.view), write_optional(out, image.ortho), write_optional(out, image.sun);
  if (image.view) write_optional(out, image.view->motion);
  out(image.taken_utc);
  out(static_cast<std::uint64_t>(image.footprint.size()));
  for (const auto& ring : image.footprint) {
    out(static_cast<std::uint64_t>(ring.size()));
    for (const auto& corner : ring) layout(out, corner);
  }
  out(image.area), out(image.gsd);
  layout(out, image.common_covariance);
  write_optional(out, image.dem_constraint), write_optional(out, image.dem_shift);
}

ImageView read_image(ByteReader& in) {
  ImageView image;
  in(image.name), in(image.columns), in(image.rows);
  read_optional(in, image.view), read_optional(in, image.ortho), read_optional(in, image.sun);
  if (image.view) read_optional(in, image.view->motion);
  in(image.taken_utc);
  image.footprint.resize(in.length(8));
  for (auto& ring : image.footprint) {
    ring.resize(in.length(16));
    for (auto& corner : ring) layout(in, corner);
  }
  in(image.area), in(image.gsd);
  layout(in, image.common_covariance);
  read_optional(in, image.dem_constraint), read_optional(in, image.dem_shift);
  return image;
}

}  // namespace

std::string Codec<ImageView>::encode(const ImageView& image) {
  ByteWriter out;
  write(out, image);
  return out.take();
}

ImageView Codec<ImageView>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  ImageView image = read_image(in);
  in.expect_end();
  return image;
}

std::string Codec<std::vector<ImageView>>::encode(const std::vector<ImageView>& images) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(images.size()));
  for (const ImageView& image : images) write(out, image);
  return out.take();
}

std::vector<ImageView> Codec<std::vector<ImageView>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<ImageView> images(in.length(85));
  for (ImageView& image : images) image = read_image(in);
  in.expect_end();
  return images;
}

}  // namespace waymark::pipeline
