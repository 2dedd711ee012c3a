// SPDX-License-Identifier: Apache-2.0
#include "importers/images/exif_tags.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace waymark::importers {
namespace {

struct FileCloser {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

struct TagName {
  int tag;
  const char* name;
};

// EXIF 2.32, tables 4 to 15: those that are used.
constexpr std::array kMain{TagName{0x10f, "EXIF_Make"}, TagName{0x110, "EXIF_Model"},
                           TagName{0x112, "EXIF_Orientation"}, TagName{0x132, "EXIF_DateTime"}};
constexpr std::array kPicture{TagName{0x9003, "EXIF_DateTimeOriginal"},
                              TagName{0x9010, "EXIF_OffsetTime"},
                              TagName{0x9011, "EXIF_OffsetTimeOriginal"},
                              TagName{0x9291, "EXIF_SubSecTime_Original"},
                              TagName{0x920a, "EXIF_FocalLength"},
                              TagName{0xa002, "EXIF_PixelXDimension"},
                              TagName{0xa003, "EXIF_PixelYDimension"},
                              TagName{0xa20e, "EXIF_FocalPlaneXResolution"},
                              TagName{0xa210, "EXIF_FocalPlaneResolutionUnit"},
                              TagName{0xa405, "EXIF_FocalLengthIn35mmFilm"}};
constexpr std::array kNavigation{TagName{1, "EXIF_GPSLatitudeRef"},  TagName{2, "EXIF_GPSLatitude"},
                                 TagName{3, "EXIF_GPSLongitudeRef"}, TagName{4, "EXIF_GPSLongitude"},
                                 TagName{5, "EXIF_GPSAltitudeRef"},  TagName{6, "EXIF_GPSAltitude"},
                                 TagName{7, "EXIF_GPSTimeStamp"},    TagName{29, "EXIF_GPSDateStamp"}};
constexpr int kPictureTags = 0x8769, kNavigationTags = 0x8825;

/// TIFF structure within a file: byte order and directories of tagged values (TIFF 6.0, section 2).
class TiffTags {
 public:
  TiffTags(VSILFILE* file, vsi_l_offset start) : file_(file), start_(start) {}

  void read(std::map<std::string, std::string>& out) {
    const std::vector<std::uint8_t> head = bytes(0, 8);
    if (head.size() < 8) return;
    big_ = head[0] == 'M' && head[1] == 'M';
    if ((!big_ && !(head[0] == 'I' && head[1] == 'I')) || number(head.data() + 2, 2) != 42) return;
    const std::uint32_t main = number(head.data() + 4, 4);
    const auto below = read_directory(main, kMain, out);
    if (below.picture) read_directory(*below.picture, kPicture, out);
    if (below.navigation) read_directory(*below.navigation, kNavigation, out);
  }

 private:
  struct Below {
    std::optional<std::uint32_t> picture = {}, navigation = {};
  };

  std::vector<std::uint8_t> bytes(std::uint32_t offset, std::size_t count) const {
    std::vector<std::uint8_t> out(count);
    if (VSIFSeekL(file_, start_ + offset, SEEK_SET) != 0) return {};
    out.resize(VSIFReadL(out.data(), 1, count, file_));
    return out;
  }

  std::uint32_t number(const std::uint8_t* from, int size) const {
    std::uint32_t out = 0;
    for (int i = 0; i < size; ++i) out = out << 8 | from[big_ ? i : size - 1 - i];
    return out;
  }

  template <std::size_t N>
  Below read_directory(std::uint32_t offset, const std::array<TagName, N>& names,
                       std::map<std::string, std::string>& out) const {
    constexpr std::size_t kEntry = 12;
    Below below;
    const std::vector<std::uint8_t> head = bytes(offset, 2);
    if (head.size() < 2) return below;
    const std::vector<std::uint8_t> all = bytes(offset + 2, kEntry * number(head.data(), 2));
    for (std::size_t at = 0; at + kEntry <= all.size(); at += kEntry) {
      const std::uint8_t* entry = &all[at];
      const int tag = static_cast<int>(number(entry, 2));
      if (tag == kPictureTags) below.picture = number(entry + 8, 4);
      if (tag == kNavigationTags) below.navigation = number(entry + 8, 4);
      for (const TagName& known : names)
        if (known.tag == tag)
          if (const std::string text = value(entry); !text.empty()) out[known.name] = text;
    }
    return below;
  }

  // Text of a value; empty if it is damaged or of a type that these tags do not have.
  std::string value(const std::uint8_t* entry) const {
    constexpr std::uint32_t kMaxBytes = 256;  // bytes
    constexpr std::array<std::uint32_t, 6> kSizes{0, 1, 1, 2, 4, 8};
    const std::uint32_t type = number(entry + 2, 2), count = number(entry + 4, 4);
    if (type == 0 || type >= kSizes.size() || count == 0 || count > kMaxBytes / kSizes[type]) return {};
    const std::size_t size = std::size_t{count} * kSizes[type];
    std::vector<std::uint8_t> raw(entry + 8, entry + 12);
    if (size > raw.size()) raw = bytes(number(entry + 8, 4), size);
    if (raw.size() < size) return {};
    if (type == 2) return {raw.begin(), std::find(raw.begin(), raw.begin() + std::ptrdiff_t(size), 0)};
    if (type < 5) return fmt::format("{}", number(raw.data(), static_cast<int>(kSizes[type])));
    std::string text;
    for (std::size_t at = 0; at < size; at += 8) {
      const double below = number(&raw[at + 4], 4);
      text += fmt::format("{}({})", at == 0 ? "" : " ", below > 0 ? number(&raw[at], 4) / below : 0);
    }
    return text;
  }

  VSILFILE* file_;
  vsi_l_offset start_;
  bool big_ = false;
};

// Returns the start of the EXIF block of a PNG file (PNG extensions 1.5, eXIf); `std::nullopt` if it has
// none.
std::optional<vsi_l_offset> exif_chunk(VSILFILE* file) {
  constexpr int kMaxChunks = 100000;
  vsi_l_offset at = 8;
  for (int i = 0; i < kMaxChunks; ++i) {
    std::array<std::uint8_t, 8> head{};
    if (VSIFSeekL(file, at, SEEK_SET) != 0 || VSIFReadL(head.data(), 1, head.size(), file) < head.size())
      return std::nullopt;
    const std::string_view kind(reinterpret_cast<const char*>(&head[4]), 4);
    if (kind == "eXIf") return at + 8;
    if (kind == "IEND") return std::nullopt;
    at += 12 +
          (vsi_l_offset{head[0]} << 24 | vsi_l_offset{head[1]} << 16 | vsi_l_offset{head[2]} << 8 | head[3]);
  }
  return std::nullopt;
}

void add_from_file(GDALDataset& dataset, std::map<std::string, std::string>& out) {
  const std::string driver = dataset.GetDriver() ? dataset.GetDriverName() : "";
  if (driver != "GTiff" && driver != "PNG") return;
  const std::unique_ptr<VSILFILE, FileCloser> file(VSIFOpenL(dataset.GetDescription(), "rb"));
  if (!file) return;
  const std::optional<vsi_l_offset> start = driver == "PNG" ? exif_chunk(file.get()) : vsi_l_offset{0};
  if (start) TiffTags(file.get(), *start).read(out);
}

}  // namespace

std::string ExifTags::text(const std::string& name) const {
  const auto found = values.find(name);
  std::string text = found == values.end() ? "" : found->second;
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text;
}

ExifTags read_exif_tags(GDALDataset& dataset) {
  ExifTags out;
  add_from_file(dataset, out.values);
  for (const char* domain : {"EXIF", ""})  // of TIFF, of JPEG
    for (char** line = dataset.GetMetadata(domain); line && *line; ++line) {
      const std::string_view item(*line);
      const std::size_t equals = item.find('=');
      if (item.starts_with("EXIF_") && equals != item.npos)
        out.values[std::string(item.substr(0, equals))] = item.substr(equals + 1);
    }
  return out;
}

}  // namespace waymark::importers
