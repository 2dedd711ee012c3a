// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::test {

/// How an object is marked in the images of the made world: the value of one pixel. Lengths in pixels.
struct Mark {
  int value;
  const char* type;
  double diameter;
  double shadow;  ///< 0: it casts none
};

inline constexpr Mark kLampPost{250, "lamp_post", 2, 28};  // 14 times as high as wide, with the sun at 35 deg
inline constexpr Mark kHaystack{240, "haystack", 10, 9};
inline constexpr Mark kTallHaystack{235, "haystack", 4, 60};
inline constexpr Mark kPothole{230, "pothole", 30, 0};
inline constexpr Mark kMarks[] = {kLampPost, kHaystack, kTallHaystack, kPothole};

}  // namespace waymark::test
