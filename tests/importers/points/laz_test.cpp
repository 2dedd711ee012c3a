// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cstring>
#include <filesystem>
#include <random>

#include "importers/points/find_las.hpp"
#include "importers/points/las_catalogue.hpp"
#include "importers/points/las_runs.hpp"
#include "importers/points/laz/integer_decoder.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/arithmetic_encoder.hpp"
#include "tests/support/made_points.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<LasPoint> all_points(const std::string& path) {
  const LasHeader header = read_las_header(path);
  std::vector<LasPoint> points;
  for (const LasRun& run : las_runs(header))
    for (const LasPoint& p : read_run(header, run)) points.push_back(p);
  EXPECT_EQ(points.size(), header.points);
  return points;
}

std::vector<std::vector<RawPoint>> in_chunks(const std::vector<RawPoint>& points,
                                             std::vector<std::size_t> sizes) {
  std::vector<std::vector<RawPoint>> chunks;
  auto from = points.begin();
  for (const std::size_t size : sizes) {
    chunks.emplace_back(from, from + static_cast<std::ptrdiff_t>(size));
    from += static_cast<std::ptrdiff_t>(size);
  }
  return chunks;
}

void expect_same_as_las(const LazFile& file, const std::string& what) {
  EXPECT_EQ(all_points(write_text("a.laz", laz_bytes(file))),
            all_points(write_text("a.las", las_bytes(file))))
      << what;
}

TEST(ArithmeticDecoder, DecodesWhatTheObviousEncoderWrites) {
  std::mt19937 random(7);
  for (const unsigned symbols : {2U, 3U, 16U, 33U, 64U, 256U, 516U, 2048U}) {
    std::vector<unsigned> sent;
    test::ArithmeticEncoder into;
    SlowModel slow(symbols);
    SlowBitModel slow_bit;
    for (int i = 0; i < 20000; ++i) {
      sent.push_back(random() % 4 == 0 ? static_cast<unsigned>(random() % symbols)
                                       : static_cast<unsigned>(i / 900) % symbols);
      into.symbol(slow, sent.back());
      into.bit(slow_bit, sent.back() % 2);
      into.bits(1 + sent.back() % 32, sent.back() & 1);
    }
    const std::string bytes = into.finish();
    ArithmeticDecoder from({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
    SymbolModel model(symbols);
    BitModel bit;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      ASSERT_EQ(from.symbol(model), sent[i]) << symbols << " symbols, number " << i;
      ASSERT_EQ(from.bit(bit), sent[i] % 2);
      ASSERT_EQ(from.bits(1 + sent[i] % 32), sent[i] & 1);
    }
    EXPECT_EQ(from.consumed(), bytes.size());
  }
}

TEST(IntegerDecoder, DecodesAnyNumber) {
  std::mt19937 random(8);
  std::vector<std::int32_t> sent{
      0, 1, -1, 2, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max(), 0};
  for (int i = 0; i < 5000; ++i) sent.push_back(static_cast<std::int32_t>(random()) >> random() % 32);
  test::ArithmeticEncoder into;
  IntegerEncoder encoder(32, 3);
  for (std::size_t i = 0; i < sent.size(); ++i) encoder.put(into, i > 0 ? sent[i - 1] : 0, sent[i], i % 3);
  const std::string bytes = into.finish();
  ArithmeticDecoder from({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
  IntegerDecoder decoder(32, 3);
  for (std::size_t i = 0; i < sent.size(); ++i)
    ASSERT_EQ(decoder.next(from, i > 0 ? sent[i - 1] : 0, static_cast<unsigned>(i % 3)), sent[i]) << i;
}

TEST(Laz, EveryPointFormatIsReadLikeLas) {
  for (int format = 0; format <= 10; ++format)
    for (unsigned seed = 0; seed < 6; ++seed) {
      LazFile file{.format = format, .extra_bytes = static_cast<int>(seed % 3)};
      const auto points = made_points(seed, 1500, format, seed % 2 ? 0.05 : 0);
      file.chunks = in_chunks(points, {600, 600, 300});
      expect_same_as_las(file, fmt::format("format {}, seed {}", format, seed));
    }
}

TEST(Laz, ChunksMayHaveAnySize) {
  for (const int format : {1, 6}) {
    LazFile file{.format = format};
    const auto points = made_points(3, 1000, format);
    file.variable = true;
    file.chunks = in_chunks(points, {1, 700, 2, 297});
    expect_same_as_las(file, "variable chunks");
    file.table_at_end = true;
    expect_same_as_las(file, "the position of the table at the end");
    file = {.format = format, .chunks = {{points[0]}}};
    expect_same_as_las(file, "one point");
  }
  LazFile file{.format = 3, .extra_bytes = 2, .chunks = {made_points(4, 500, 3)}, .whole = true};
  expect_same_as_las(file, "no chunks");
}

std::string refusal_of(const std::string& bytes) {
  const std::string path = write_text("bad.laz", bytes);
  const std::string said = message_of([&] { all_points(path); });
  EXPECT_THAT(said, HasSubstr("bad.laz"));
  return said;
}

// The record of the compression is the second one: after that of the CRS, 54 + 16 bytes.
TEST(Laz, SaysWhatIsWrong) {
  const LazFile file{.format = 1, .chunks = in_chunks(made_points(1, 300, 1), {200, 100})};
  const std::string good = laz_bytes(file);
  const std::size_t record = 227 + 70, body = record + 54, first = body + 34 + 2 * 6;
  const auto with = [&](std::size_t at, int value) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(value);
    return bytes;
  };
  EXPECT_THAT(refusal_of(with(record + 2, 'x')), HasSubstr("the record that says how is missing"));
  EXPECT_THAT(refusal_of(with(body, 9)), HasSubstr("unknown method (compressor 9, coder 0)"));
  EXPECT_THAT(refusal_of(with(body, 3)), HasSubstr("compressor 3 is not for point format 1"));
  EXPECT_THAT(refusal_of(with(body + 34 + 4, 1)), HasSubstr("version 1 of the format; 2 can be read"));
  EXPECT_THAT(refusal_of(with(104, 0x82)), HasSubstr("does not describe points of format 2"));
  EXPECT_THAT(refusal_of(with(104, 0x8F)), HasSubstr("point format 15"));
  EXPECT_THAT(refusal_of(with(body + 12, 0)), HasSubstr("0 points"));
  EXPECT_THAT(refusal_of(with(first, 0).substr(0, first + 3)), HasSubstr("ends before the table"));
  EXPECT_THAT(refusal_of(good.substr(0, good.size() - 30)), HasSubstr("truncated"));
  std::string unfinished = good;
  std::fill_n(unfinished.begin() + static_cast<std::ptrdiff_t>(first), 8, '\0');
  EXPECT_THAT(refusal_of(unfinished), HasSubstr("was not finished"));
  EXPECT_THAT(refusal_of(with(107, 45)), HasSubstr("damaged"));
  EXPECT_THAT(refusal_of(with(108, 5)), HasSubstr("the header states 1324 points, its chunks hold 400"));
  std::string damaged = good;
  std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(first + 8 + 28 + 200), 60, '\xFF');
  EXPECT_THAT(refusal_of(damaged), HasSubstr("damaged"));
}

TEST(Laz, TheNameDoesNotMatter) {
  const LazFile file{.format = 0, .chunks = {made_points(1, 50, 0)}};
  EXPECT_EQ(all_points(write_text("really_las.laz", las_bytes(file))),
            all_points(write_text("really_laz.las", laz_bytes(file))));
}

TEST(FindLas, AFolderStandsForItsFiles) {
  const std::filesystem::path folder = std::filesystem::path(write_text("x.txt", "")).parent_path() / "tiles";
  std::filesystem::create_directories(folder);
  for (const char* name : {"b.LAZ", "a.las", "c.copc.laz", "notes.txt"})
    write_text("tiles/" + std::string(name), "x");
  EXPECT_THAT(find_las_files({"other.las", folder.string()}),
              ElementsAre("other.las", (folder / "a.las").string(), (folder / "b.LAZ").string(),
                          (folder / "c.copc.laz").string()));
  std::filesystem::create_directories(folder / "none");
  EXPECT_THAT(message_of([&] { find_las_files({(folder / "none").string()}); }),
              HasSubstr("no files whose names end in .las or .laz"));
  EXPECT_THAT(message_of([&] { read_las_header(folder.string()); }), HasSubstr("it is a folder"));
}

// Points of 60 x 60 m in the octree of five levels.
LazFile plain_field() {
  std::mt19937 random(5);
  LazFile file{.format = 6, .scale = 0.01};
  file.chunks.resize(1);
  for (int i = 0; i < 20000; ++i) {
    RawPoint p;
    p.at = {static_cast<std::int32_t>(random() % 6000) - 3000,
            static_cast<std::int32_t>(random() % 6000) - 3000, static_cast<std::int32_t>(random() % 2000)};
    p.classification = i % 3 == 0 ? 2 : 5;
    file.chunks[0].push_back(p);
  }
  return file;
}

std::vector<std::array<double, 3>> sorted_in(const LasCatalogue& catalogue, const LasBox& box) {
  std::vector<std::array<double, 3>> found;
  catalogue.visit(box, [&](const LasPoint& p) { found.push_back({p.x, p.y, p.z}); });
  std::ranges::sort(found);
  return found;
}

TEST(Copc, AWindowReadsOnlyItsNodes) {
  const LazFile file = plain_field();
  const std::string copc = write_text("field.copc.laz", copc_bytes(file, 5)),
                    las = write_text("field.las", las_bytes(file));
  const std::size_t nodes = las_runs(read_las_header(copc)).size();
  EXPECT_GT(nodes, 1000U);
  const LasCatalogue tree({copc}, 1 << 28), plain({las}, 1 << 28);
  EXPECT_EQ(tree.runs_decoded(), 1U);  // the root has ground points
  EXPECT_FALSE(tree.all_read());
  EXPECT_EQ(tree.points(), plain.points());
  EXPECT_EQ(tree.first_returns(), plain.first_returns());
  EXPECT_NEAR(tree.box().left, plain.box().left, 1e-9);
  EXPECT_NEAR(tree.box().high, plain.box().high, 1e-9);
  const LasBox window{500010, 5000012, 500014, 5000016};
  const auto found = sorted_in(tree, window);
  EXPECT_GT(found.size(), 50U);
  EXPECT_EQ(found, sorted_in(plain, window));
  EXPECT_LT(tree.runs_decoded(), nodes / 20);
  EXPECT_EQ(sorted_in(tree, plain.box()), sorted_in(plain, plain.box()));
}

TEST(Copc, WithoutGroundAllIsRead) {
  LazFile file = plain_field();
  for (RawPoint& p : file.chunks[0]) p.classification = 1;
  const std::string copc = write_text("field.copc.laz", copc_bytes(file, 3));
  const LasCatalogue tree({copc}, 1 << 28);
  EXPECT_EQ(tree.ground_points(), 0U);
  EXPECT_TRUE(tree.all_read());
  EXPECT_EQ(tree.points(), 20000U);
}

TEST(Copc, IsReadAsLazWithoutItsHierarchy) {
  std::string bytes = copc_bytes(plain_field(), 3);
  bytes[375 + 2] = 'x';
  const LasHeader header = read_las_header(write_text("field.laz", bytes));
  EXPECT_FALSE(header.copc);
  EXPECT_EQ(all_points(write_text("field.laz", bytes)).size(), 20000U);
}

TEST(Copc, SaysWhatIsWrong) {
  const std::string good = copc_bytes(plain_field(), 3);
  const auto with = [&](std::size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return refusal_of(bytes);
  };
  const std::size_t info = 375 + 54, page = good.size() - 32;
  EXPECT_THAT(with(info + 24, 0.0), HasSubstr("half side of 0"));
  EXPECT_THAT(with(info + 40, std::uint64_t{1} << 60), HasSubstr("a page of"));
  EXPECT_THAT(with(info + 48, std::uint64_t{31}), HasSubstr("a page of 31 bytes"));
  EXPECT_THAT(with(page, std::int32_t{40}), HasSubstr("no node 40-"));
  EXPECT_THAT(with(page + 16, std::uint64_t{good.size()}), HasSubstr("would have"));
  EXPECT_THAT(with(247, std::uint64_t{5}), HasSubstr("the header states 5"));
  EXPECT_THAT(with(info, 600000.0), HasSubstr("lies outside its node"));
}

TEST(Catalogue, ThreadsDoNotMatter) {
  const LazFile file{.format = 1,
                     .chunks = in_chunks(made_points(9, 4000, 1), {500, 500, 500, 500, 500, 500, 500, 500})};
  const std::string path = write_text("many.laz", laz_bytes(file));
  const auto visited = [&] {
    std::vector<LasPoint> points;
    const LasCatalogue catalogue({path}, 1 << 20);
    catalogue.visit(catalogue.box(), [&](const LasPoint& p) { points.push_back(p); });
    return points;
  };
  const auto all = visited();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(all, visited());
}

// The points of tests/importers/points/laz: three flight lines, three channels, wild values among them. The
// files were written by another program than ours, in chunks of 100.
std::vector<LasPoint> points_by_formula(int format) {
  std::uint32_t state = 12345;
  const auto draw = [&] {
    state = state * 1664525 + 1013904223;
    return static_cast<int>(state >> 8);
  };
  std::vector<LasPoint> points;
  for (int i = 0; i < 240; ++i) {
    const int line = i / 97, k = i % 97, returns = 1 + i / 7 % 4, number = 1 + i % returns;
    int x = (line % 2 ? 97 - k : k) * 53 + draw() % 9;
    const int y = line * 201 + draw() % 31;
    int z = 1000 + (number < returns ? draw() % 1500 : draw() % 20);
    if (i % 131 == 0) x = draw() - (1 << 23), z = -draw();
    draw();  // intensity
    int type = number == returns ? 2 : 3 + draw() % 3;
    if (format >= 6 && i % 61 == 0) type = 100;
    // User data, time, colours and waveforms.
    for (int skipped = (i % 40 == 0) + (i % 71 == 0) + 4 + 28; skipped > 0; --skipped) draw();
    points.push_back({500000 + 0.01 * x, 5000000 + 0.01 * y, 0.01 * z, static_cast<std::uint8_t>(type),
                      static_cast<std::uint8_t>(number), i % 50 == 0, static_cast<std::uint8_t>(returns)});
  }
  return points;
}

TEST(LazOfAnotherProgram, EveryPointFormatIsRead) {
  for (int format = 0; format <= 10; ++format)
    EXPECT_EQ(
        all_points(fmt::format("{}/tests/importers/points/laz/format_{}.laz", WAYMARK_SOURCE_DIR, format)),
        points_by_formula(format))
        << format;
}

// Files of the shared data whose points are published as LAS, too.
TEST(RealLaz, IsReadLikeItsLas) {
  const std::filesystem::path folder = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/forest";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not on this machine";
  EXPECT_EQ(all_points(folder / "lidr/MixedConifer.laz"), all_points(folder / "lidr/MixedConifer.las"));
  const auto clip = all_points(folder / "spanner/ALS_Clip.laz");
  const LasHeader header = read_las_header(folder / "spanner/ALS_Clip.laz");
  double low = 1e300, high = -1e300;
  for (const LasPoint& p : clip) low = std::min(low, p.z), high = std::max(high, p.z);
  EXPECT_NEAR(low, header.low[2], 1e-6);
  EXPECT_NEAR(high, header.high[2], 1e-6);
}

}  // namespace
}  // namespace waymark::test
