// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "geo/dem_handle.hpp"
#include "importers/cameras/camera_set.hpp"
#include "importers/cameras/control_points.hpp"
#include "importers/images/find_images.hpp"
#include "importers/images/image_set.hpp"
#include "importers/images/list_images.hpp"
#include "importers/tables/text_table.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark::importers {
namespace {

std::vector<std::string> format_names() {
  std::vector<std::string> names{"auto"};
  for (std::string& name : camera_formats()) names.push_back(std::move(name));
  return names;
}

struct LoadImages {
  struct Options {
    ImageListing listing;
    std::string camera_format = "auto", similarity, sun = "auto", image_sun_angle;
    Meters gsd{0};
    Degrees sun_azimuth{0}, sun_elevation{0}, sun_sd{Sun{}.sd};

    void describe(OptionVisitor& option) {
      CameraImport& import = listing.import;
      option("files", listing.files,
             {.help = "Images, patterns (*.png) or folders of images; empty: those named in the camera file, "
                      "near it"});
      option("cameras", listing.cameras,
             {.help = "Camera file, or a pattern for several of one format; empty: orthophotos"});
      option("camera_format", camera_format,
             {.help = "Format of the camera files", .choices = format_names()});
      option("interior", import.interior,
             {.help = "File with the interior orientation, for formats that store it separately"});
      option("crs", import.crs, {.help = "CRS of the map; empty: that of the DEM"});
      option("camera_crs", import.camera_crs,
             {.help = "CRS of camera positions if their file names none; empty: the map's"});
      option(
          "height_offset", import.height_offset,
          {.help =
               "Added to every camera height: minus the height of the DEM's zero (geoid, areoid) above the "
               "cameras' (ellipsoid, sphere)",
           .min = -1e5,
           .max = 1e5});
      option("control_points", import.control_points,
             {.help = "CSV file of control points that georeference an arbitrary camera frame"});
      option("similarity", similarity,
             {.help = "Instead of control points: scale,qw,qx,qy,qz,x,y,z with map = scale * rotation * "
                      "frame + shift"});
      option("rotation_sd", import.rotation_sd,
             {.help = "Standard deviation of camera angles if the camera file gives none",
              .min = 0,
              .max = 180});
      option("position_sd", import.position_sd,
             {.help = "Standard deviation of camera positions if the camera file gives none",
              .min = 0,
              .max = 1e6});
      option("sun", sun,
             {.help = "Source of the sun: auto (camera file, label, then time and position), time, none",
              .choices = {"auto", "time", "none"}});
      option(
          "sun_azimuth", sun_azimuth,
          {.help = "Direction towards the sun for all images, clockwise from map north; needs sun_elevation",
           .min = -360,
           .max = 360});
      option("sun_elevation", sun_elevation,
             {.help = "Elevation of the sun above the horizon; 0: unknown", .min = 0, .max = 90});
      option("sun_sd", sun_sd, {.help = "Standard deviation of the given sun angles", .min = 0, .max = 90});
      option("image_sun_angle", image_sun_angle,
             {.help = "Direction towards the sun in the images, degrees from x (right) towards y (down); "
                      "empty: unknown"});
      option("time_zone", listing.time_zone,
             {.help = "UTC offset for EXIF times without one: Z, +08:00; empty: unknown"});
      option("gsd", gsd,
             {.help = "Ground size of a pixel, for images without georeference; 0: unknown",
              .min = 0,
              .max = 1e5});
      option("saturated", listing.saturated,
             {.help = "Pixel value from which pixels are saturated; 0: the largest 8 or 16 bit number",
              .min = 0,
              .max = 1e12});
      option("band", listing.band, {.help = "Band to use, from 1; 0: brightness", .min = 0, .max = 10000});
    }
  };

  static constexpr pipeline::In<DemHandle> dem{"dem"};
  static constexpr pipeline::Out<ImageSet> images{"image_set"};
  static constexpr pipeline::Out<std::vector<pipeline::ImageItem>> items{"images"};

  static pipeline::StageSpec spec() {
    return {.name = "load_images",
            .summary = "Lists images with their camera or georeference and the sun",
            .version = 2,
            .scope = pipeline::Scope::map,
            .lists = pipeline::Scope::image,
            .inputs = {dem},
            .outputs = {images, items}};
  }

  // The units hash the images one by one; this stage depends on their names and sizes only.
  static std::vector<std::string> input_files(const Options& options) {
    namespace fs = std::filesystem;
    std::vector<std::string> files;
    const ImageListing& listing = options.listing;
    for (const std::string& file : {listing.cameras, listing.import.interior, listing.import.control_points})
      if (!file.empty()) files.push_back(file);
    std::set<std::string> folders;
    for (const std::string& file : listing.files)
      folders.insert((is_image_name(file) ? fs::path(file).parent_path() / "." : fs::path(file)).string() +
                     "/");
    if (listing.files.empty())
      for (const char* place : {"./", "images/", "../images/", "../../images/"})
        folders.insert((fs::path(listing.cameras).parent_path() / place).string());
    files.insert(files.end(), folders.begin(), folders.end());
    return files;
  }

  static ImageListing listing_of(const Options& options, const pipeline::StageContext& unit) {
    ImageListing listing = options.listing;
    for (std::string& file : listing.files) file = unit.path(file);
    for (std::string* file : {&listing.cameras, &listing.import.interior, &listing.import.control_points})
      if (!file->empty()) *file = unit.path(*file);
    if (options.camera_format != "auto") listing.format = options.camera_format;
    if (!options.similarity.empty()) listing.import.map_from_frame = similarity_from_text(options.similarity);
    using From = ImageListing::SunFrom;
    listing.sun_from = options.sun == "time" ? From::time : options.sun == "none" ? From::nothing : From::all;
    if (options.sun_elevation.value > 0)
      listing.sun = Sun{.azimuth = Degrees{std::fmod(options.sun_azimuth.value + 360, 360.0)},
                        .elevation = options.sun_elevation,
                        .sd = options.sun_sd};
    if (!options.image_sun_angle.empty()) listing.image_sun_angle = angle_of(options.image_sun_angle);
    if (options.gsd.value > 0) listing.gsd = options.gsd;
    return listing;
  }

  static Degrees angle_of(const std::string& text) {
    double angle = 0;
    if (!parse_number(text, angle) || !(angle >= -360 && angle <= 360))
      throw Error(ErrorCode::usage, "image_sun_angle is '" + text + "'", "",
                  "degrees, -360 to 360, or empty");
    return Degrees{angle};
  }

  static void run(const Options& options, pipeline::StageContext& unit) {
    ImageListing listing = listing_of(options, unit);
    if (listing.import.crs.empty()) listing.import.crs = unit.read(dem)->geometry().where.crs.wkt2();
    const ListedImages listed = list_images(listing);
    for (const std::string& warning : listed.warnings) unit.warn(warning);
    std::vector<pipeline::ImageItem> list;
    for (ImageInfo info : listed.images) {
      if (info.columns == 0) unit.do_not_keep();              // it could not be read this time
      const std::string path = std::exchange(info.path, {});  // the path does not change the image
      list.push_back({static_cast<std::int64_t>(list.size()), info.name, path, to_json(info)});
    }
    unit.count_out(static_cast<std::int64_t>(list.size()));
    unit.write(images, image_set(listed.images, static_cast<int>(listing.band)));
    unit.write(items, std::move(list));
  }
};

}  // namespace

void register_stage_load_images(pipeline::Registry& registry);
void register_stage_load_images(pipeline::Registry& registry) {
  registry.add<LoadImages>();
}

}  // namespace waymark::importers
