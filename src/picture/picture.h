#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mssim {

/// A colour in sRGB.
struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// The sRGB code of an intensity of light (both 0 to 1; IEC 61966-2-1), and the inverse.
double srgb_code(double light);
double srgb_light(double code);

inline constexpr Rgb black{0, 0, 0}, white{255, 255, 255};

/// Pixels in rows from left to right, row 0 at the top.
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<Rgb> pixels;

  Picture() = default;
  Picture(std::uint32_t w, std::uint32_t h, Rgb colour = white);

  /// The pixel in column `x` of row `y`, which must be inside.
  Rgb& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
  const Rgb& at(std::uint32_t x, std::uint32_t y) const { return pixels[std::size_t{y} * width + x]; }

  friend bool operator==(const Picture&, const Picture&) = default;
};

/// A box of whole pixels from column `left` and row `top` on. Parts outside a picture are cut off.
struct PixelBox {
  int left = 0, top = 0, width = 0, height = 0;
};

/// `over` on `under` with a coverage of `coverage` / 255, per channel and rounded to the nearest.
constexpr Rgb blended(Rgb under, Rgb over, std::uint8_t coverage) {
  const auto channel = [coverage](unsigned below, unsigned above) {
    return static_cast<std::uint8_t>((below * (255u - coverage) + above * coverage + 127) / 255);
  };
  return {channel(under.red, over.red), channel(under.green, over.green), channel(under.blue, over.blue)};
}

/// Blends `colour` over every pixel of `box`; by default it replaces them.
void fill(Picture& picture, const PixelBox& box, Rgb colour, std::uint8_t coverage = 255);

/// Copies `pasted` into `picture`, its top left pixel to column `left` of row `top`. Parts outside are cut
/// off.
void paste(Picture& picture, const Picture& pasted, int left, int top);

/// The bytes of a PNG file of `picture`: 8 bits per channel, sRGB, no alpha. The same picture gives the same
/// bytes with the same libpng and zlib. Throws std::runtime_error for a picture without pixels or one that
/// libpng refuses.
std::string png_of(const Picture& picture);

/// Throws MissingProgram, with the remedy, if the font for text in pictures is not installed. All functions
/// that write text on pictures (sheets with captions, legends, colour bars) do so; this checks in advance.
void require_font();

/// A picture of a sheet and the text below it; empty: none.
struct CaptionedPicture {
  Picture picture;
  std::string caption;
};

/// The pictures in rows of `columns`, from left to right, each with its caption below it, on white. The last
/// row may be incomplete; fewer pictures than columns are one row. Long captions are shortened; if all
/// captions are empty, they take no room. Throws std::invalid_argument without columns or pictures, and for
/// pictures of different sizes.
Picture sheet_of(std::span<const CaptionedPicture> pictures, std::uint32_t columns);

}  // namespace mssim
