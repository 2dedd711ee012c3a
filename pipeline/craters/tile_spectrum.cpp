// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/tile_spectrum.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

namespace waymark::pipeline {
namespace {

// Eight columns (or rows) are transformed at once, one in each lane. Radix 4: decimation in frequency forward
// and in time backward (Gentleman & Sande 1966, Cooley & Tukey 1965), so spectra stay in digit-reversed order
// and need no reordering.
constexpr int kLanes = 8, kGroups = kTileSide / kLanes;
using Lanes [[gnu::vector_size(sizeof(float) * kLanes)]] = float;
using Four [[gnu::vector_size(sizeof(float) * 4)]] = float;

struct Columns {
  std::array<Lanes, kTileSide> real, imaginary;
};

struct Twiddle {
  float cosine, sine;
};

// exp(-2 pi i k / kTileSide).
const std::array<Twiddle, kTileSide>& twiddles() {
  static const auto made = [] {
    std::array<Twiddle, kTileSide> all{};
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double angle = -2 * std::numbers::pi * double(k) / kTileSide;
      all[k] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
    }
    return all;
  }();
  return made;
}

template <int kLength>
[[gnu::always_inline]] inline void forward_stage(Columns& c, const Twiddle* twiddle) {
  constexpr int quarter = kLength / 4, step = kTileSide / kLength;
  for (int j = 0; j < quarter; ++j) {
    const Twiddle w1 = twiddle[j * step], w2 = twiddle[2 * j * step], w3 = twiddle[3 * j * step];
    for (int first = j; first < kTileSide; first += kLength) {
      Lanes *re = c.real.data() + first, *im = c.imaginary.data() + first;
      const Lanes sum_re = re[0] + re[2 * quarter], sum_im = im[0] + im[2 * quarter];
      const Lanes off_re = re[0] - re[2 * quarter], off_im = im[0] - im[2 * quarter];
      const Lanes odd_re = re[quarter] + re[3 * quarter], odd_im = im[quarter] + im[3 * quarter];
      const Lanes turned_re = im[quarter] - im[3 * quarter], turned_im = re[3 * quarter] - re[quarter];
      re[0] = sum_re + odd_re, im[0] = sum_im + odd_im;
      const Lanes a_re = off_re + turned_re, a_im = off_im + turned_im;
      const Lanes b_re = sum_re - odd_re, b_im = sum_im - odd_im;
      const Lanes d_re = off_re - turned_re, d_im = off_im - turned_im;
      if constexpr (quarter == 1) {
        re[1] = a_re, im[1] = a_im, re[2] = b_re, im[2] = b_im, re[3] = d_re, im[3] = d_im;
      } else {
        re[quarter] = a_re * w1.cosine - a_im * w1.sine, im[quarter] = a_re * w1.sine + a_im * w1.cosine;
        re[2 * quarter] = b_re * w2.cosine - b_im * w2.sine;
        im[2 * quarter] = b_re * w2.sine + b_im * w2.cosine;
        re[3 * quarter] = d_re * w3.cosine - d_im * w3.sine;
        im[3 * quarter] = d_re * w3.sine + d_im * w3.cosine;
      }
    }
  }
}

template <int kLength>
[[gnu::always_inline]] inline void inverse_stage(Columns& c, const Twiddle* twiddle) {
  constexpr int quarter = kLength / 4, step = kTileSide / kLength;
  for (int j = 0; j < quarter; ++j) {
    const Twiddle w1 = twiddle[j * step], w2 = twiddle[2 * j * step], w3 = twiddle[3 * j * step];
    for (int first = j; first < kTileSide; first += kLength) {
      Lanes *re = c.real.data() + first, *im = c.imaginary.data() + first;
      Lanes a_re = re[quarter], a_im = im[quarter], b_re = re[2 * quarter], b_im = im[2 * quarter],
            d_re = re[3 * quarter], d_im = im[3 * quarter];
      if constexpr (quarter > 1) {
        a_re = re[quarter] * w1.cosine + im[quarter] * w1.sine;
        a_im = im[quarter] * w1.cosine - re[quarter] * w1.sine;
        b_re = re[2 * quarter] * w2.cosine + im[2 * quarter] * w2.sine;
        b_im = im[2 * quarter] * w2.cosine - re[2 * quarter] * w2.sine;
        d_re = re[3 * quarter] * w3.cosine + im[3 * quarter] * w3.sine;
        d_im = im[3 * quarter] * w3.cosine - re[3 * quarter] * w3.sine;
      }
      const Lanes sum_re = re[0] + b_re, sum_im = im[0] + b_im, off_re = re[0] - b_re, off_im = im[0] - b_im;
      const Lanes odd_re = a_re + d_re, odd_im = a_im + d_im, turned_re = d_im - a_im,
                  turned_im = a_re - d_re;
      re[0] = sum_re + odd_re, im[0] = sum_im + odd_im;
      re[quarter] = off_re + turned_re, im[quarter] = off_im + turned_im;
      re[2 * quarter] = sum_re - odd_re, im[2 * quarter] = sum_im - odd_im;
      re[3 * quarter] = off_re - turned_re, im[3 * quarter] = off_im - turned_im;
    }
  }
}

[[gnu::always_inline]] inline void forward_fft(Columns& c, const Twiddle* twiddle) {
  forward_stage<256>(c, twiddle), forward_stage<64>(c, twiddle), forward_stage<16>(c, twiddle),
      forward_stage<4>(c, twiddle);
}

[[gnu::always_inline]] inline void inverse_fft(Columns& c, const Twiddle* twiddle) {
  inverse_stage<4>(c, twiddle), inverse_stage<16>(c, twiddle), inverse_stage<64>(c, twiddle),
      inverse_stage<256>(c, twiddle);
}

// Rows of `from` become columns of `to`: four by four, `stride` floats between rows.
[[gnu::always_inline]] inline void transpose(const float* from, int from_stride, float* to, int to_stride) {
  std::array<Four, 4> r;
  for (std::size_t i = 0; i < 4; ++i)
    std::memcpy(&r[i], from + static_cast<std::ptrdiff_t>(i) * from_stride, sizeof(Four));
  const Four a = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5),
             b = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7),
             c = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5),
             d = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
  r = {__builtin_shufflevector(a, c, 0, 1, 4, 5), __builtin_shufflevector(a, c, 2, 3, 6, 7),
       __builtin_shufflevector(b, d, 0, 1, 4, 5), __builtin_shufflevector(b, d, 2, 3, 6, 7)};
  for (std::size_t i = 0; i < 4; ++i)
    std::memcpy(to + static_cast<std::ptrdiff_t>(i) * to_stride, &r[i], sizeof(Four));
}

[[gnu::always_inline]] inline void rows_to_lanes(const float* rows, Lanes* lanes) {
  auto* to = reinterpret_cast<float*>(lanes);
  for (int x = 0; x < kTileSide; x += 4)
    for (int row = 0; row < kLanes; row += 4)
      transpose(rows + row * kTileSide + x, kTileSide, to + x * kLanes + row, kLanes);
}

[[gnu::always_inline]] inline void lanes_to_rows(const Lanes* lanes, float* rows) {
  const auto* from = reinterpret_cast<const float*>(lanes);
  for (int x = 0; x < kTileSide; x += 4)
    for (int row = 0; row < kLanes; row += 4)
      transpose(from + x * kLanes + row, kLanes, rows + row * kTileSide + x, kTileSide);
}

[[gnu::always_inline]] inline void load_columns(const ComplexTile& tile, int group, Columns& c) {
  for (std::size_t y = 0; y < kTileSide; ++y) {
    const std::size_t at = y * kTileSide + static_cast<std::size_t>(group * kLanes);
    std::memcpy(&c.real[y], tile.real.data() + at, sizeof(Lanes));
    std::memcpy(&c.imaginary[y], tile.imaginary.data() + at, sizeof(Lanes));
  }
}

[[gnu::always_inline]] inline void store_columns(const Columns& c, int group, ComplexTile& tile) {
  for (std::size_t y = 0; y < kTileSide; ++y) {
    const std::size_t at = y * kTileSide + static_cast<std::size_t>(group * kLanes);
    std::memcpy(tile.real.data() + at, &c.real[y], sizeof(Lanes));
    std::memcpy(tile.imaginary.data() + at, &c.imaginary[y], sizeof(Lanes));
  }
}

// A spectrum stores the lanes of its columns for each group of eight rows.
[[gnu::always_inline]] inline void spectrum_body(ComplexTile& tile) {
  const Twiddle* twiddle = twiddles().data();
  Columns c;
  for (int group = 0; group < kGroups; ++group) {
    load_columns(tile, group, c);
    forward_fft(c, twiddle);
    store_columns(c, group, tile);
  }
  for (int group = 0; group < kGroups; ++group) {
    float *real = tile.real.data() + group * kLanes * kTileSide,
          *imaginary = tile.imaginary.data() + group * kLanes * kTileSide;
    rows_to_lanes(real, c.real.data());
    rows_to_lanes(imaginary, c.imaginary.data());
    forward_fft(c, twiddle);
    std::memcpy(real, c.real.data(), sizeof c.real);
    std::memcpy(imaginary, c.imaginary.data(), sizeof c.imaginary);
  }
}

[[gnu::always_inline]] inline void product_body(const ComplexTile& spectrum, const ComplexTile& kernel,
                                                ComplexTile& product) {
  const Twiddle* twiddle = twiddles().data();
  Columns c;
  for (int group = 0; group < kGroups; ++group) {
    const auto part = [&](const std::vector<float>& all, int x) {
      return all.data() + (group * kTileSide + x) * kLanes;
    };
    for (int x = 0; x < kTileSide; ++x) {
      Lanes a, b, p, q;
      std::memcpy(&a, part(spectrum.real, x), sizeof a),
          std::memcpy(&b, part(spectrum.imaginary, x), sizeof b);
      std::memcpy(&p, part(kernel.real, x), sizeof p), std::memcpy(&q, part(kernel.imaginary, x), sizeof q);
      c.real[static_cast<std::size_t>(x)] = a * p - b * q;
      c.imaginary[static_cast<std::size_t>(x)] = a * q + b * p;
    }
    inverse_fft(c, twiddle);
    lanes_to_rows(c.real.data(), product.real.data() + group * kLanes * kTileSide);
    lanes_to_rows(c.imaginary.data(), product.imaginary.data() + group * kLanes * kTileSide);
  }
  for (int group = 0; group < kGroups; ++group) {
    load_columns(product, group, c);
    inverse_fft(c, twiddle);
    store_columns(c, group, product);
  }
}

#ifdef __x86_64__
[[gnu::target("avx2")]] void spectrum_avx2(ComplexTile& tile) {
  spectrum_body(tile);
}
[[gnu::target("avx2")]] void product_avx2(const ComplexTile& spectrum, const ComplexTile& kernel,
                                          ComplexTile& product) {
  product_body(spectrum, kernel, product);
}
#endif

}  // namespace

void forward_transform(ComplexTile& tile) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return spectrum_avx2(tile);
#endif
  spectrum_body(tile);
}

void inverse_transform_product(const ComplexTile& spectrum, const ComplexTile& kernel, ComplexTile& product) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return product_avx2(spectrum, kernel, product);
#endif
  product_body(spectrum, kernel, product);
}

}  // namespace waymark::pipeline
