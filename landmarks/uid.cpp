// SPDX-License-Identifier: Apache-2.0
#include "landmarks/uid.hpp"

#include <cmath>
#include <cstdint>
#include <string_view>
#include <unordered_map>

namespace waymark::inline landmarks {
namespace {

// FNV-1a (Fowler, Noll, Vo), 64 bits, then MurmurHash3's finaliser, so that near positions differ in all
// digits.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdu;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
  return h ^ (h >> 33);
}

std::string base32(std::uint64_t number) {  // 13 digits contain 65 bits
  std::string digits(13, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, number >>= 5)
    *digit = "0123456789abcdefghjkmnpqrstvwxyz"[number & 31];
  return digits;
}

// "mt" for mountain_top, "ro" for rock.
std::string initials(std::string_view name) {
  std::string letters(1, name[0]);
  for (std::size_t i = 1; i + 1 < name.size(); ++i)
    if (name[i] == '_') letters += name[i + 1];
  return letters.size() > 1 ? letters : std::string(name.substr(0, 2));
}

struct RoundedPosition {
  std::int64_t x = 0, y = 0;
};

RoundedPosition round_position(const Crs& crs, const Point<MapCrs>& position) {
  if (crs.kind() == CrsKind::geographic) {
    constexpr std::int64_t turn = 3600000000;  // 360 degrees
    const auto x = std::llround(position.xyz.x() * 1e7) % turn;
    return {x < 0 ? x + turn : x, std::llround(position.xyz.y() * 1e7)};
  }
  const double centimetres = 100 * crs.metres_per_unit();
  return {std::llround(position.xyz.x() * centimetres), std::llround(position.xyz.y() * centimetres)};
}

}  // namespace

std::string make_uid(const LandmarkType& type, const Crs& crs, const Point<MapCrs>& position) {
  const RoundedPosition at = round_position(crs, position);
  const std::string what =
      type.name + '|' + crs.id() + '|' + std::to_string(at.x) + '|' + std::to_string(at.y);
  return initials(type.name) + '-' + base32(hash(what));
}

void assign_uids(const TypeRegistry& types, const Crs& crs, std::span<Landmark> landmarks) {
  std::unordered_map<std::string, int> taken;
  taken.reserve(landmarks.size());
  for (Landmark& landmark : landmarks) {
    landmark.uid = make_uid(types[landmark.type], crs, landmark.position);
    if (const int count = ++taken[landmark.uid]; count > 1) landmark.uid += '-' + std::to_string(count);
  }
}

}  // namespace waymark::inline landmarks
