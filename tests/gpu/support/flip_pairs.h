// Pairs of pictures for tests of FLIP, as 8-bit sRGB.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace weir::test {

using Srgb = std::array<std::uint8_t, 3>;

struct FlipPair {
  std::string name;
  std::int32_t width;
  std::int32_t height;
  double pixels_per_degree;
  std::vector<Srgb> reference;  ///< rows from the top
  std::vector<Srgb> test;
};

/// Returns a number from 0 to 255 that is the same on every machine.
inline int flip_noise(std::int32_t x, std::int32_t y, std::uint32_t channel) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U ^ (channel + 1) * 83492791U;
  h = (h ^ (h >> 13U)) * 1274126177U;
  return static_cast<int>((h ^ (h >> 16U)) & 255U);
}

/// `picture(x, y)` returns the two colours of a pixel.
template <typename Picture>
FlipPair flip_pair(std::string name, std::int32_t width, std::int32_t height, double ppd, const Picture& picture) {
  FlipPair pair{std::move(name), width, height, ppd, {}, {}};
  for (std::int32_t y = 0; y < height; ++y) {
    for (std::int32_t x = 0; x < width; ++x) {
      const std::array<std::array<int, 3>, 2> colors = picture(x, y);
      const auto srgb = [](const std::array<int, 3>& c) {
        Srgb result{};
        for (std::size_t k = 0; k < 3; ++k) {
          result[k] = static_cast<std::uint8_t>(c[k] < 0 ? 0 : c[k] > 255 ? 255 : c[k]);
        }
        return result;
      };
      pair.reference.push_back(srgb(colors[0]));
      pair.test.push_back(srgb(colors[1]));
    }
  }
  return pair;
}

inline std::vector<FlipPair> flip_pairs() {
  using Two = std::array<std::array<int, 3>, 2>;
  constexpr double kPpd = 67.0206433;
  const auto gradient = [](int x, int y) { return std::array{x * 2, y * 3, 255 - x - y}; };
  const auto noisy = [gradient](int x, int y) {
    const auto c = gradient(x, y);
    const auto n = [&](std::uint32_t k) { return (flip_noise(x, y, k) - 128) / 4; };
    return Two{c, {c[0] + n(0), c[1] + n(1), c[2] + n(2)}};
  };
  const auto shade = [](int v) { return std::array{v, v, v}; };
  return {
      flip_pair("noise on a gradient", 120, 80, kPpd, noisy),
      flip_pair("the same seen from further away", 120, 80, 134, noisy),
      flip_pair("the same seen from near", 120, 80, 11.5, noisy),
      flip_pair("checkerboard against its mean", 64, 64, kPpd,
                [&](int x, int y) {
                  return Two{shade((x + y) % 2 * 255), shade(188)};
                }),
      flip_pair("checkerboard of 8 pixels shifted by one", 70, 50, kPpd,
                [&](int x, int y) {
                  const auto board = [](int u, int v) { return ((u / 8 + v / 8) % 2) * 200 + 20; };
                  return Two{shade(board(x, y)), shade(board(x + 1, y))};
                }),
      flip_pair("thin lines, one missing", 90, 61, kPpd,
                [&](int x, int y) {
                  const bool line = x % 15 == 7 || y == 30;
                  return Two{shade(line ? 240 : 12), shade(line && x != 37 ? 240 : 12)};
                }),
      flip_pair("a single dot", 41, 41, kPpd,
                [&](int x, int y) {
                  return Two{shade(128), x == 20 && y == 20 ? std::array{255, 0, 0} : shade(128)};
                }),
      flip_pair("brighter by 10", 48, 32, kPpd,
                [&](int x, int y) {
                  return Two{shade(x * 4 + y), shade(x * 4 + y + 10)};
                }),
      flip_pair("green against blue", 16, 16, kPpd,
                [](int, int) {
                  return Two{{{0, 255, 0}, {0, 0, 255}}};
                }),
      flip_pair("black against white", 24, 16, kPpd,
                [&](int, int) {
                  return Two{shade(0), shade(255)};
                }),
      flip_pair("one pixel", 1, 1, kPpd,
                [](int, int) {
                  return Two{{{200, 30, 60}, {60, 30, 200}}};
                }),
      flip_pair("smaller than the filters", 5, 3, kPpd,
                [&](int x, int y) {
                  return Two{shade(x * 50), shade(x * 50 + y * 20)};
                }),
      flip_pair("one row", 37, 1, kPpd,
                [&](int x, int) {
                  return Two{shade(x * 6), shade(222 - x * 6)};
                }),
      flip_pair("one column", 1, 150, kPpd,
                [&](int, int y) {
                  return Two{shade(y), {y, flip_noise(0, y, 1), y}};
                }),
      flip_pair("several bands of rows", 30, 130, kPpd,
                [&](int x, int y) {
                  return Two{shade(flip_noise(x, y, 0)), {flip_noise(x, y, 0), flip_noise(x / 3, y / 3, 1), 90}};
                }),
  };
}

}  // namespace weir::test
