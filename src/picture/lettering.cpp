#include "picture/lettering.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "picture/glyph_raster.h"
#include "picture/glyphs.h"

namespace mssim {
namespace {

constexpr std::string_view dots = "…";

/// The whole pixels between the lines of two characters: more where the pen is wider than its lines.
int letter_gap(double size_px, const Pen& pen) {
  return std::max(2, static_cast<int>(std::lround(0.14 * size_px + pen.width - pen.line)));
}

/// The bytes of the UTF-8 character at the beginning of `text`: one if there is none.
std::size_t character_size(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xc2 ? 0
                           : first < 0xe0 ? 2
                           : first < 0xf0 ? 3
                           : first < 0xf5 ? 4
                                          : 0;
  if (size == 0 || size > text.size()) return 1;
  const auto continues = [](char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; };
  return std::ranges::all_of(text.substr(1, size - 1), continues) ? size : 1;
}

char32_t character_at(std::string_view text, std::size_t size) {
  const auto byte = [&](std::size_t i) { return static_cast<char32_t>(static_cast<unsigned char>(text[i])); };
  if (size == 1) return byte(0) < 0x80 ? byte(0) : U'\ufffd';
  char32_t character = byte(0) & (0xffu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) character = character << 6 | (byte(i) & 0x3f);
  return character;
}

/// Calls `use` with each character and the pixels between the left edge of the text and its own.
template <class Use>
int walk_along(std::string_view text, const Letters& letters, const Use& use) {
  const Pen pen(letters.size_px);
  const int gap = letter_gap(letters.size_px, pen);
  int x = 0;
  for (std::size_t size = 0; !text.empty(); text.remove_prefix(size)) {
    size = character_size(text);
    const Glyph& glyph = glyph_of(character_at(text, size));
    use(glyph, pen, x);
    x += width_px(glyph, pen) + gap;
  }
  return std::max(0, x - gap);
}

}  // namespace

int Letters::capital_height() const {
  const Pen pen(size_px);
  return static_cast<int>(std::lround(26 * pen.scale)) + pen.line;
}

int Letters::descent() const { return static_cast<int>(std::lround(8 * Pen(size_px).scale)); }

int Letters::line_distance() const { return static_cast<int>(std::lround(1.4 * size_px)); }

double letter_size_for(std::uint32_t picture_height) { return std::max(11.0, 0.025 * picture_height); }

int text_width(std::string_view text, const Letters& letters) {
  return walk_along(text, letters, [](const Glyph&, const Pen&, int) {});
}

void draw_text(Picture& picture, std::string_view text, int x, int baseline, const Letters& letters,
               Alignment alignment) {
  if (alignment != Alignment::left) x -= text_width(text, letters) / (alignment == Alignment::centre ? 2 : 1);
  walk_along(text, letters, [&](const Glyph& glyph, const Pen& pen, int from_start) {
    const GlyphMask mask = mask_of(glyph, pen);
    for (int row = 0; row < mask.height; ++row)
      for (int column = 0; column < mask.width; ++column)
        if (const std::uint8_t covered = mask.coverage[mask.index_of(column, row)])
          blend(picture, x + from_start + mask.left + column, baseline + mask.top + row, letters.colour,
                covered);
  });
}

std::string shortened(std::string_view text, int width, const Letters& letters) {
  if (text_width(text, letters) <= width) return std::string(text);
  std::string fitting;
  for (std::size_t end = 0; end < text.size(); end += character_size(text.substr(end))) {
    const std::string candidate = std::string(text.substr(0, end)) + std::string(dots);
    if (text_width(candidate, letters) > width) break;
    fitting = candidate;
  }
  return fitting;
}

}  // namespace mssim
