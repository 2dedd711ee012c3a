// SPDX-License-Identifier: Apache-2.0
#include "importers/images/image.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "importers/images/image_set.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Grid<double> counted(std::int64_t columns, std::int64_t rows) {
  Grid<double> cells(columns, rows);
  for (std::int64_t i = 0; i < columns * rows; ++i)
    cells.cells()[static_cast<std::size_t>(i)] = static_cast<double>(i);
  return cells;
}

std::string grey(const std::string& name, GDALDataType type, const Grid<double>& cells) {
  return write_raster({.path = "/vsimem/" + name, .cells = cells, .type = type, .transform = {}, .crs = ""});
}

std::string coloured(const std::string& name, const std::vector<double>& bands,
                     std::optional<double> nodata = {}) {
  const std::string path =
      write_raster({.path = "/vsimem/" + name,
                    .cells = Grid<double>(2, 1, bands[0]),
                    .type = GDT_Byte,
                    .transform = {},
                    .crs = "",
                    .bands = static_cast<int>(bands.size()),
                    .options = {bands.size() == 4 ? "ALPHA=YES" : "INTERLEAVE=PIXEL", "PHOTOMETRIC=RGB"}});
  const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
  for (int b = 0; b < static_cast<int>(bands.size()); ++b) {
    double value = bands[static_cast<std::size_t>(b)];
    EXPECT_EQ(
        file->GetRasterBand(b + 1)->RasterIO(GF_Write, 1, 0, 1, 1, &value, 1, 1, GDT_Float64, 0, 0, nullptr),
        CE_None);
    if (nodata) file->GetRasterBand(b + 1)->SetNoDataValue(*nodata);
  }
  return path;
}

TEST(Image, ReadsEightSixteenAndFloat) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16, GDT_Int16, GDT_Float32, GDT_Float64}) {
    const auto image = import_image(grey("i.tif", type, counted(5, 4)));
    EXPECT_EQ(image->info().columns, 5);
    EXPECT_EQ(image->info().rows, 4);
    EXPECT_EQ(image->info().name, "i.tif");
    EXPECT_FALSE(image->info().ortho);
    const Pixels window = image->read({1, 2, 2, 2});
    EXPECT_THAT(window.cells(), ElementsAre(11, 12, 16, 17));
    EXPECT_EQ(image->info().saturated, type == GDT_Byte ? 255 : type == GDT_UInt16 ? 65535 : 0);
  }
}

TEST(Image, HasNoDataOutside) {
  const auto image = import_image(grey("i.tif", GDT_Byte, counted(2, 2)));
  const Pixels window = image->read({-1, -1, 4, 4});
  EXPECT_TRUE(std::isnan(window(0, 0)));
  EXPECT_EQ(window(1, 1), 0);
  EXPECT_EQ(window(2, 2), 3);
  EXPECT_TRUE(std::isnan(window(3, 3)));
  EXPECT_EQ(image->read({50, 50, 1, 1}).columns(), 1);
}

TEST(Image, OnePixelIsAnImage) {
  EXPECT_EQ(import_image(grey("i.tif", GDT_Byte, Grid<double>(1, 1, 7)))->read({0, 0, 1, 1})(0, 0), 7);
}

TEST(Image, ColoursGiveLuminance) {
  const auto image = import_image(coloured("c.tif", {100, 50, 200}));
  EXPECT_NEAR(image->read({1, 0, 1, 1})(0, 0), 0.2126 * 100 + 0.7152 * 50 + 0.0722 * 200, 1e-4);
  EXPECT_EQ(import_image("/vsimem/c.tif", {.band = 3})->read({1, 0, 1, 1})(0, 0), 200);
}

TEST(Image, BlackInOneColourIsNotMissing) {
  EXPECT_NEAR(import_image(coloured("c.tif", {0, 50, 0}, 0))->read({1, 0, 1, 1})(0, 0), 35.76, 1e-3);
  EXPECT_TRUE(std::isnan(import_image(coloured("c.tif", {0, 0, 0}, 0))->read({1, 0, 1, 1})(0, 0)));
}

TEST(Image, TransparentPixelsAreMissing) {
  EXPECT_TRUE(std::isnan(import_image(coloured("a.tif", {9, 9, 9, 0}))->read({1, 0, 1, 1})(0, 0)));
  EXPECT_NEAR(import_image(coloured("a.tif", {9, 9, 9, 255}))->read({1, 0, 1, 1})(0, 0), 9, 1e-5);
}

TEST(Image, LargeImagesAreReadInStripsThatJoin) {
  const Grid<double> cells = counted(1500, 1500);
  const Pixels all = import_image(grey("l.tif", GDT_Float32, cells))->read({0, 0, 1500, 1500});
  for (std::int64_t r = 0; r < 1500; r += 7) ASSERT_EQ(all(r, r), static_cast<float>(cells(r, r)));
}

TEST(Orthophoto, PixelZeroLiesAtItsCentre) {
  const auto path = write_raster({.path = "/vsimem/o.tif",
                                  .cells = counted(4, 4),
                                  .type = GDT_Byte,
                                  .transform = GeoTransform{500000, 2, 0, 4000000, 0, -2}});
  const ImageInfo info = import_image(path)->info();
  EXPECT_EQ(info.ortho->x0, 500001);
  EXPECT_EQ(info.ortho->y0, 3999999);
  EXPECT_EQ(info.ortho->dy, -2);
  EXPECT_EQ(info.crs.id(), "EPSG:32633");
  EXPECT_FALSE(import_image(path, {.georeference = false})->info().ortho);
}

// A world file gives the centre of the first pixel, a GeoTIFF its corner.
TEST(Orthophoto, WorldFilesGiveTheCentre) {
  const auto folder = std::filesystem::path(write_text("i.pgm", "P5 2 2 255\nabcd")).parent_path();
  std::ofstream(folder / "i.wld") << "0.5\n0\n0\n-0.5\n1000\n2000\n";
  const auto image = import_image((folder / "i.pgm").string(), {.crs = "EPSG:32633"});
  ASSERT_TRUE(image->info().ortho);
  EXPECT_EQ(image->info().ortho->x0, 1000);
  EXPECT_EQ(image->info().ortho->y0, 2000);
  const auto nowhere = import_image((folder / "i.pgm").string());
  EXPECT_EQ(nowhere->info().crs.kind(), CrsKind::local);
  EXPECT_THAT(nowhere->warnings(), ElementsAre(HasSubstr("names no CRS")));
}

TEST(Orthophoto, DegreesAreRefusedWithACommandThatReprojects) {
  const auto path = write_raster({.path = "/vsimem/d.tif",
                                  .cells = counted(4, 4),
                                  .type = GDT_Byte,
                                  .transform = GeoTransform{13, 0.001, 0, 52, 0, -0.001},
                                  .crs = "EPSG:4326"});
  EXPECT_THAT(message_of([&] { import_image(path); }),
              AllOf(HasSubstr("in degrees"), HasSubstr("gdalwarp"),
                    HasSubstr("+proj=tmerc +lat_0=51.9980 +lon_0=13.0020")));
  EXPECT_FALSE(import_image(path, {.georeference = false})->info().ortho);
}

TEST(Orthophoto, RotatedOnesAreRefusedUnlessTheyHaveACamera) {
  const auto path = write_raster({.path = "/vsimem/r.tif",
                                  .cells = counted(4, 4),
                                  .type = GDT_Byte,
                                  .transform = GeoTransform{0, 1, 0.2, 0, 0.2, -1}});
  EXPECT_THAT(message_of([&] { import_image(path); }), AllOf(HasSubstr("rotated"), HasSubstr("gdalwarp")));
  PosedCamera view;
  view.camera = {.columns = 4, .rows = 4, .fx = 5, .fy = 5, .cx = 1.5, .cy = 1.5};
  EXPECT_TRUE(import_image(path, {.view = view, .crs = "EPSG:32633"})->info().view);
}

TEST(Image, CameraIsScaledToAnImageOfTheSameShapeOnly) {
  PosedCamera view;
  view.camera = {.columns = 400, .rows = 200, .fx = 500, .fy = 500, .cx = 199.5, .cy = 99.5};
  const auto half = import_image(grey("h.tif", GDT_Byte, Grid<double>(200, 100, 1)), {.view = view});
  EXPECT_EQ(half->info().view->camera.fx, 250);
  EXPECT_EQ(half->info().view->camera.cx, 99.5);  // the middle stays the middle
  EXPECT_THAT(half->warnings(), ElementsAre(HasSubstr("scaled by 0.5")));
  EXPECT_THAT(
      message_of([&] { import_image(grey("s.tif", GDT_Byte, Grid<double>(200, 150, 1)), {.view = view}); }),
      HasSubstr("not the same picture"));
}

TEST(Image, ReportsTheFault) {
  EXPECT_THAT(message_of([] { import_image("/vsimem/none.png"); }), HasSubstr("no such file"));
  EXPECT_THAT(message_of([] { import_image(write_text("t.png", "no image")); }), HasSubstr("not a raster"));
  EXPECT_THAT(message_of([] { import_image(grey("i.tif", GDT_Byte, counted(2, 2)), {.band = 2}); }),
              HasSubstr("there is no band 2"));
  EXPECT_THAT(message_of([] { import_image(grey("c.tif", GDT_CFloat32, counted(2, 2))); }),
              HasSubstr("complex"));
}

TEST(Image, TruncatedFilesFailWhenRead) {
  const auto path =
      write_raster({.path = std::filesystem::path(write_text("x", "")).replace_filename("cut.tif"),
                    .cells = counted(500, 500),
                    .type = GDT_UInt16,
                    .transform = {},
                    .crs = ""});
  std::filesystem::resize_file(path, 200000);
  const auto image = import_image(path);
  EXPECT_THAT(message_of([&] { image->read({0, 0, 500, 500}); }), HasSubstr("damaged"));
}

// GDAL fills the rest of a JPEG that ends early with grey, and only warns.
TEST(Image, TruncatedJpegsFailWhenReadWhateverTheirKind) {
  Grid<double> noise(400, 300);
  for (std::size_t i = 0; i < noise.cells().size(); ++i)
    noise.cells()[i] = static_cast<double>((i * 2654435761U >> 8) % 256);
  const std::string source = grey("noise.tif", GDT_Byte, noise);
  const std::unique_ptr<GDALDataset> from(GDALDataset::Open(source.c_str()));
  for (const char* progressive : {"PROGRESSIVE=NO", "PROGRESSIVE=YES"}) {
    const auto path = std::filesystem::path(write_text("x", "")).replace_filename("cut.jpg");
    const char* const options[] = {progressive, nullptr};
    GDALClose(GetGDALDriverManager()->GetDriverByName("JPEG")->CreateCopy(path.c_str(), from.get(), FALSE,
                                                                          options, nullptr, nullptr));
    EXPECT_FALSE(std::isnan(import_image(path)->read({0, 0, 400, 300})(399, 299))) << "it is sound";
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 3);
    const auto image = import_image(path);
    EXPECT_THAT(message_of([&] {
                  image->read({0, 0, 400, 300});
                }),
                AllOf(HasSubstr("damaged"), HasSubstr("Premature end"), HasSubstr("cut.jpg")))
        << progressive;
  }
}

TEST(ImageSet, OnDiskIsARecipe) {
  PosedCamera view;
  view.camera = {.columns = 5,
                 .rows = 4,
                 .fx = 5.1,
                 .fy = 5,
                 .cx = 2,
                 .cy = 1.5,
                 .skew = 0.01,
                 .lens = Camera::Lens::fisheye,
                 .distortion = {0.1, -0.02}};
  view.grid_from_camera.transform.translation() << 1e6, 2e6, 123.456;
  view.covariance(2, 4) = view.covariance(4, 2) = 1e-7;
  const ImageHandle image =
      import_image(grey("i.tif", GDT_Byte, counted(5, 4)), {.view = view,
                                                            .crs = "EPSG:32633",
                                                            .sun = Sun{Degrees{10}, Degrees{20}},
                                                            .gsd = Meters{0.3},
                                                            .taken_utc = "x"});
  const std::string bytes = pipeline::Codec<ImageSet>::encode({image});
  const ImageSet again = pipeline::Codec<ImageSet>::decode(bytes);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(pipeline::Codec<ImageSet>::encode(again), bytes);
  EXPECT_EQ(again[0]->info().view->camera, image->info().view->camera);
  EXPECT_EQ(again[0]->info().view->covariance, view.covariance);
  EXPECT_EQ(again[0]->info().crs.id(), "EPSG:32633");
  EXPECT_EQ(again[0]->info().sun, image->info().sun);
  EXPECT_EQ(again[0]->read({0, 0, 5, 4}), image->read({0, 0, 5, 4}));
}

TEST(ImageSet, NoticesAnImageThatHasChanged) {
  const ImageHandle image = import_image(grey("i.tif", GDT_Byte, counted(5, 4)));
  const ImageSet set = pipeline::Codec<ImageSet>::decode(pipeline::Codec<ImageSet>::encode({image}));
  grey("i.tif", GDT_Byte, counted(6, 4));
  EXPECT_THAT(message_of([&] { set[0]->read({0, 0, 5, 4}); }), HasSubstr("--rerun-from load_images"));
}

TEST(LocalProjection, IsTrueToScaleAtItsPlace) {
  for (const char* crs : {"EPSG:4326", "IAU_2015:49900", "IAU_2015:30100"}) {
    const Crs degrees = Crs::from_text(crs);
    const Crs local = Crs::from_text(local_projection(degrees, 137.44, -4.59));
    const auto [x, y] = CrsTransform(geographic_crs(local), local)(137.44, -4.59);
    EXPECT_NEAR(x, 0, 1e-3) << crs;
    EXPECT_NEAR(y, 0, 1e-3) << crs;
    EXPECT_EQ(local.body().name, degrees.body().name);
  }
}

}  // namespace
}  // namespace waymark::test
