// SPDX-License-Identifier: Apache-2.0
#include "importers/images/image_labels.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <map>

namespace waymark::test {
using namespace importers;
namespace {

TimeTaken time_of_exif(const std::map<std::string, std::string>& items) {
  const GdalListener quiet;
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const GdalDataset dataset(memory->Create("", 4, 4, 1, GDT_Byte, nullptr));
  for (const auto& [name, value] : items) dataset->SetMetadataItem(name.c_str(), value.c_str());
  return time_taken(*dataset, "");
}

// Names of items as GDAL gives them.
TEST(TimeTaken, TheClockOfTheCameraCountsFractionsOfASecond) {
  const TimeTaken plain = time_of_exif({{"EXIF_DateTimeOriginal", "2016:06:23 16:31:59"}});
  const TimeTaken precise =
      time_of_exif({{"EXIF_DateTimeOriginal", "2016:06:23 16:31:59"}, {"EXIF_SubSecTime_Original", "25"}});
  ASSERT_TRUE(plain.clock && precise.clock);
  EXPECT_FALSE(plain.utc);
  EXPECT_EQ(precise.local, plain.local);
  EXPECT_DOUBLE_EQ(*precise.clock - *plain.clock, 0.25);
  EXPECT_FALSE(time_of_exif({}).clock);
}

}  // namespace
}  // namespace waymark::test
