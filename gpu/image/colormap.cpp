#include "gpu/image/colormap.h"

#include <algorithm>
#include <array>
#include <span>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

namespace {

/// Control point: position in [0, 1] and sRGB in 0..255.
struct Stop {
  float position;
  std::array<float, 3> srgb;
};

constexpr std::array kGray{Stop{0.00F, {0, 0, 0}}, Stop{1.00F, {255, 255, 255}}};
constexpr std::array kWhite{Stop{0.00F, {250, 250, 250}}, Stop{1.00F, {250, 250, 250}}};
constexpr std::array kHeat{Stop{0.00F, {10, 4, 20}}, Stop{0.30F, {128, 18, 40}}, Stop{0.55F, {221, 80, 20}},
                           Stop{0.80F, {250, 180, 50}}, Stop{1.00F, {255, 250, 220}}};
constexpr std::array kCoolWarm{Stop{0.00F, {52, 84, 190}}, Stop{0.25F, {126, 166, 240}}, Stop{0.50F, {224, 221, 218}},
                               Stop{0.75F, {240, 150, 118}}, Stop{1.00F, {180, 14, 42}}};
// Dark violet to yellow through blue-green; the lightness rises evenly.
constexpr std::array kDusk{Stop{0.00F, {64, 8, 86}}, Stop{0.25F, {60, 80, 140}}, Stop{0.50F, {34, 142, 140}},
                           Stop{0.75F, {96, 202, 96}}, Stop{1.00F, {252, 230, 40}}};
// Soft tissue, then bone. Light colours, because a path tracer takes the colour as the fraction of light scattered.
constexpr std::array kCt{Stop{0.00F, {176, 92, 76}}, Stop{0.25F, {222, 154, 124}}, Stop{0.50F, {238, 204, 172}},
                         Stop{0.75F, {248, 232, 210}}, Stop{1.00F, {255, 252, 246}}};
// Water: deep blue to foam.
constexpr std::array kWater{Stop{0.00F, {8, 24, 58}}, Stop{0.35F, {20, 84, 140}}, Stop{0.70F, {84, 176, 204}},
                            Stop{1.00F, {240, 252, 252}}};
// Maps of matplotlib with evenly rising lightness: "viridis", "plasma", "inferno" and "magma" (S. van der Walt, N.
// Smith and E. Firing, 2015, CC0) and "cividis" (J. Nunez, C. Anderton and R. Renslow, 2018), which looks the same to
// the colour-blind. Each is within 1/255 of its 256 colours.
constexpr std::array kViridis{
    Stop{0.0000F, {68, 1, 84}},    Stop{0.0706F, {72, 27, 109}},  Stop{0.1373F, {70, 48, 126}},
    Stop{0.2157F, {63, 72, 137}},  Stop{0.3412F, {48, 106, 142}}, Stop{0.4902F, {33, 142, 141}},
    Stop{0.5529F, {30, 157, 137}}, Stop{0.6000F, {34, 168, 132}}, Stop{0.6510F, {47, 180, 124}},
    Stop{0.7098F, {72, 193, 110}}, Stop{0.7647F, {101, 203, 94}}, Stop{0.8196F, {134, 213, 73}},
    Stop{0.9255F, {205, 225, 29}}, Stop{0.9529F, {223, 227, 24}}, Stop{0.9725F, {236, 229, 27}},
    Stop{0.9961F, {251, 231, 35}}, Stop{1.0000F, {253, 231, 37}}};
constexpr std::array kPlasma{
    Stop{0.0000F, {13, 8, 135}},   Stop{0.0275F, {32, 6, 143}},   Stop{0.1020F, {67, 3, 158}},
    Stop{0.1922F, {103, 0, 168}},  Stop{0.2510F, {126, 3, 168}},  Stop{0.2980F, {143, 13, 164}},
    Stop{0.3765F, {170, 35, 149}}, Stop{0.5020F, {204, 71, 120}}, Stop{0.6549F, {235, 117, 86}},
    Stop{0.7686F, {250, 155, 61}}, Stop{0.8667F, {254, 192, 41}}, Stop{0.9216F, {251, 215, 36}},
    Stop{0.9843F, {242, 242, 39}}, Stop{0.9961F, {240, 247, 36}}, Stop{1.0000F, {240, 249, 33}}};
constexpr std::array kInferno{
    Stop{0.0000F, {0, 0, 4}},      Stop{0.0118F, {1, 1, 8}},       Stop{0.0471F, {7, 5, 27}},
    Stop{0.0941F, {21, 11, 55}},   Stop{0.1373F, {38, 12, 81}},    Stop{0.1725F, {54, 9, 97}},
    Stop{0.2196F, {74, 12, 107}},  Stop{0.2784F, {98, 20, 110}},   Stop{0.3569F, {130, 32, 108}},
    Stop{0.4471F, {166, 45, 96}},  Stop{0.5333F, {199, 62, 76}},   Stop{0.6078F, {223, 83, 55}},
    Stop{0.6863F, {241, 113, 31}}, Stop{0.7569F, {250, 144, 8}},   Stop{0.7804F, {251, 155, 6}},
    Stop{0.8000F, {252, 165, 10}}, Stop{0.8353F, {251, 182, 26}},  Stop{0.8863F, {248, 207, 58}},
    Stop{0.9216F, {244, 225, 86}}, Stop{0.9569F, {241, 241, 121}}, Stop{0.9843F, {246, 250, 150}},
    Stop{1.0000F, {252, 255, 164}}};
constexpr std::array kCividis{
    Stop{0.0000F, {0, 34, 78}},     Stop{0.0784F, {0, 48, 112}},    Stop{0.0902F, {1, 50, 113}},
    Stop{0.1098F, {18, 53, 112}},   Stop{0.1451F, {35, 60, 110}},   Stop{0.2196F, {59, 73, 108}},
    Stop{0.3451F, {90, 95, 110}},   Stop{0.5294F, {131, 129, 121}}, Stop{0.6706F, {166, 156, 116}},
    Stop{0.7961F, {199, 183, 103}}, Stop{0.8941F, {226, 205, 84}},  Stop{0.9569F, {245, 220, 65}},
    Stop{0.9843F, {253, 227, 52}},  Stop{0.9922F, {254, 229, 53}},  Stop{1.0000F, {254, 232, 56}}};
constexpr std::array kMagma{
    Stop{0.0000F, {0, 0, 4}},      Stop{0.0235F, {2, 2, 13}},      Stop{0.0784F, {14, 11, 43}},
    Stop{0.1451F, {36, 18, 83}},   Stop{0.1882F, {54, 16, 107}},   Stop{0.2275F, {71, 16, 120}},
    Stop{0.2902F, {96, 24, 128}},  Stop{0.4078F, {144, 42, 129}},  Stop{0.5059F, {184, 55, 121}},
    Stop{0.5961F, {220, 72, 105}}, Stop{0.6549F, {238, 91, 94}},   Stop{0.7059F, {247, 114, 92}},
    Stop{0.7569F, {252, 138, 98}}, Stop{0.8235F, {254, 170, 116}}, Stop{0.9216F, {254, 216, 154}},
    Stop{1.0000F, {252, 253, 191}}};

struct Map {
  std::string_view name;
  std::span<const Stop> stops;
};
constexpr std::array kMaps{Map{"gray", kGray},          Map{"white", kWhite},     Map{"heat", kHeat},
                           Map{"cool-warm", kCoolWarm}, Map{"dusk", kDusk},       Map{"ct", kCt},
                           Map{"water", kWater},        Map{"magma", kMagma},     Map{"viridis", kViridis},
                           Map{"plasma", kPlasma},      Map{"inferno", kInferno}, Map{"cividis", kCividis}};

}  // namespace

float srgb_from_linear(float linear) {
  const float v = clamped(linear, 0.0F, 1.0F);
  return v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1.0F / 2.4F) - 0.055F;
}

float linear_from_srgb(float srgb) {
  const float v = clamped(srgb, 0.0F, 1.0F);
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

std::vector<std::string_view> colormap_names() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kMaps));
  for (const Map& map : kMaps) names.push_back(map.name);
  return names;
}

std::vector<Float3> colormap(std::string_view name, std::size_t entries) {
  const auto map = std::find_if(kMaps.begin(), kMaps.end(), [&](const Map& m) { return m.name == name; });
  if (map == kMaps.end()) {
    std::string known;
    for (const Map& m : kMaps) known += cat(known.empty() ? "" : ", ", m.name);
    throw Error(ErrorKind::usage, cat("unknown colormap \"", name, "\"; use one of ", known));
  }
  std::vector<Float3> colours(entries);
  auto stop = map->stops.begin();
  for (std::size_t i = 0; i < entries; ++i) {
    const float u = entries == 1 ? 0.0F : static_cast<float>(i) / static_cast<float>(entries - 1);
    while (stop + 2 != map->stops.end() && u > stop[1].position) ++stop;
    const float f = clamped((u - stop[0].position) / (stop[1].position - stop[0].position), 0.0F, 1.0F);
    const auto channel = [&](std::size_t c) {
      return linear_from_srgb(mix(stop[0].srgb[c], stop[1].srgb[c], f) / 255);
    };
    colours[i] = {channel(0), channel(1), channel(2)};
  }
  return colours;
}

}  // namespace weir
