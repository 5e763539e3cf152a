#include "render/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace mssim {
namespace {

double encoded(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

double decoded(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

constexpr std::size_t entries = 8192;  // fine enough for 8 bits

std::uint8_t channel_of(float light) {
  static const auto codes = [] {
    std::array<std::uint8_t, entries> all{};
    for (std::size_t i = 0; i < entries; ++i)
      all[i] = static_cast<std::uint8_t>(std::lround(255 * encoded(static_cast<double>(i) / (entries - 1))));
    return all;
  }();
  return codes[static_cast<std::size_t>(std::clamp(light, 0.0F, 1.0F) * (entries - 1) + 0.5F)];
}

}  // namespace

Light light_of(const Rgb& colour) {
  const auto light = [](std::uint8_t code) { return static_cast<float>(decoded(code / 255.0)); };
  return {light(colour.red), light(colour.green), light(colour.blue)};
}

Rgb colour_of(const Light& light) { return {channel_of(light.x), channel_of(light.y), channel_of(light.z)}; }

}  // namespace mssim
