// SPDX-License-Identifier: Apache-2.0
#include "importers/images/photo_metadata.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <map>

namespace waymark::test {
using namespace importers;
namespace {

PhotoMetadata metadata_of(const std::map<std::string, std::string>& items, const char* xmp = nullptr,
                          int columns = 2000, int rows = 1125) {
  const GdalListener quiet;
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const GdalDataset dataset(memory->Create("", columns, rows, 1, GDT_Byte, nullptr));
  for (const auto& [name, value] : items) dataset->SetMetadataItem(name.c_str(), value.c_str());
  const char* lines[] = {xmp, nullptr};
  if (xmp) dataset->SetMetadata(const_cast<char**>(lines), "xml:XMP");
  return read_photo_metadata(*dataset, "made");
}

TEST(PhotoMetadata, NothingIsNeeded) {
  const PhotoMetadata m = metadata_of({});
  EXPECT_EQ(m.focal_source, FocalSource::none);
  EXPECT_DOUBLE_EQ(m.focal, 1700);
  EXPECT_DOUBLE_EQ(m.focal_sd, 0.2);
  EXPECT_FALSE(m.position);
  EXPECT_FALSE(m.gimbal);
  EXPECT_EQ(m.orientation, 1);
}

TEST(PhotoMetadata, FilmEquivalentGivesTheFocalLength) {
  const PhotoMetadata m = metadata_of({{"EXIF_FocalLengthIn35mmFilm", "20"}, {"EXIF_FocalLength", "(3.61)"}});
  EXPECT_EQ(m.focal_source, FocalSource::film_equivalent);
  EXPECT_NEAR(m.focal, 1111.1, 0.1);
}

// 8 mm at 5000 pixels per cm is 4000 px of the original, which had twice the columns.
TEST(PhotoMetadata, PlaneResolutionIsScaledToTheFile) {
  const PhotoMetadata m = metadata_of({{"EXIF_FocalLengthIn35mmFilm", "20"},
                                       {"EXIF_FocalLength", "(8)"},
                                       {"EXIF_FocalPlaneXResolution", "(5000)"},
                                       {"EXIF_FocalPlaneResolutionUnit", "3"},
                                       {"EXIF_PixelXDimension", "4000"}});
  EXPECT_EQ(m.focal_source, FocalSource::plane_resolution);
  EXPECT_NEAR(m.focal, 2000, 1e-9);
}

// Programs that turn a picture by 90 degrees often leave the dimensions in EXIF.
TEST(PhotoMetadata, TurnedPicturesKeepTheirFocalLength) {
  const std::map<std::string, std::string> items{{"EXIF_FocalLength", "(8)"},
                                                 {"EXIF_FocalPlaneXResolution", "(5000)"},
                                                 {"EXIF_FocalPlaneResolutionUnit", "3"},
                                                 {"EXIF_PixelXDimension", "4000"},
                                                 {"EXIF_PixelYDimension", "3000"}};
  EXPECT_NEAR(metadata_of(items, nullptr, 4000, 3000).focal, 4000, 1e-9);
  EXPECT_NEAR(metadata_of(items, nullptr, 3000, 4000).focal, 4000, 1e-9);
  EXPECT_NEAR(metadata_of(items, nullptr, 1500, 2000).focal, 2000, 1e-9);
}

TEST(PhotoMetadata, AFocalLengthThatCannotBeIsIgnored) {
  EXPECT_EQ(metadata_of({{"EXIF_FocalLengthIn35mmFilm", "0"}}).focal_source, FocalSource::none);
  EXPECT_EQ(metadata_of({{"EXIF_FocalLengthIn35mmFilm", "9000"}}).focal_source, FocalSource::none);
}

TEST(PhotoMetadata, PositionHasItsHemisphere) {
  const PhotoMetadata m = metadata_of({{"EXIF_GPSLatitude", "(46) (50) (33.3855)"},
                                       {"EXIF_GPSLatitudeRef", "N"},
                                       {"EXIF_GPSLongitude", "(91) (59) (40.4156)"},
                                       {"EXIF_GPSLongitudeRef", "W"},
                                       {"EXIF_GPSAltitude", "(198.309)"},
                                       {"EXIF_GPSAltitudeRef", "0x00"}});
  ASSERT_TRUE(m.position);
  EXPECT_NEAR(m.position->lat, 46.842607, 1e-6);
  EXPECT_NEAR(m.position->lon, -91.994560, 1e-6);
  EXPECT_NEAR(m.position->altitude.value(), 198.309, 1e-9);
}

TEST(PhotoMetadata, APositionOutOfRangeOrOfZerosIsNone) {
  EXPECT_FALSE(
      metadata_of({{"EXIF_GPSLatitude", "(120) (0) (0)"}, {"EXIF_GPSLongitude", "(10) (0) (0)"}}).position);
  EXPECT_FALSE(
      metadata_of({{"EXIF_GPSLatitude", "(0) (0) (0)"}, {"EXIF_GPSLongitude", "(0) (0) (0)"}}).position);
}

TEST(PhotoMetadata, GimbalAndHeightComeFromXmp) {
  const PhotoMetadata m = metadata_of({}, R"(<x:xmpmeta><rdf:Description drone-dji:RelativeAltitude="+39.80"
      drone-dji:GimbalYawDegree="+45.00" drone-dji:GimbalPitchDegree="-89.90" drone-dji:GimbalRollDegree="+0.00"/></x:xmpmeta>)");
  ASSERT_TRUE(m.gimbal);
  EXPECT_DOUBLE_EQ(m.gimbal->yaw, 45);
  EXPECT_DOUBLE_EQ(m.gimbal->pitch, -89.9);
  EXPECT_DOUBLE_EQ(m.height_above_takeoff.value(), 39.8);
  EXPECT_DOUBLE_EQ(
      metadata_of({}, "<a:RelativeAltitude>12.5</a:RelativeAltitude>").height_above_takeoff.value(), 12.5);
}

}  // namespace
}  // namespace waymark::test
