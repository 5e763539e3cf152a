#include "picture/lettering.h"

#include <ft2build.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>
#include FT_FREETYPE_H

#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The font's files in Debian, Fedora and Arch.
constexpr std::array<const char*, 3> font_files{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                                "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                                "/usr/share/fonts/TTF/DejaVuSans.ttf"};

const char* font_file() {
  for (const char* file : font_files) {
    std::error_code error;
    if (std::filesystem::exists(file, error)) return file;
  }
  throw MissingProgram(std::string("the font for text in pictures is missing, ") + font_files.front() +
                       ": install Debian's package fonts-dejavu-core");
}

/// Coverage of each pixel by a character, 0 to 255, in rows from the top.
struct GlyphMask {
  int left = 0, above = 0;  ///< offset of its first column; rows above the baseline
  int width = 0, height = 0;
  int advance = 0;  ///< distance to the next character
  std::vector<std::uint8_t> coverage;
};

void require_success(FT_Error error, const char* what) {
  if (error) throw std::runtime_error(fmt::format("FreeType failed at {}: error {}", what, error));
}

/// The font, with a cache of characters.
class Font {
 public:
  Font() {
    require_success(FT_Init_FreeType(&library_), "its start");
    const FT_Error error = FT_New_Face(library_, font_file(), 0, &face_);
    if (error) FT_Done_FreeType(library_);
    require_success(error, font_file());
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;
  ~Font() { FT_Done_FreeType(library_); }  // and its face

  const GlyphMask& mask_of(char32_t character, double size_px) {
    const auto size = static_cast<FT_F26Dot6>(std::lround(64 * size_px));
    const auto [known, is_new] = masks_.try_emplace({character, size});
    if (is_new) known->second = drawn(character, size);
    return known->second;
  }

 private:
  GlyphMask drawn(char32_t character, FT_F26Dot6 size) {
    require_success(FT_Set_Char_Size(face_, 0, size, 0, 0), "a size of letters");
    // No hinting: its result differs between releases of FreeType; outlines do not.
    require_success(FT_Load_Char(face_, character, FT_LOAD_RENDER | FT_LOAD_NO_HINTING), "a letter");
    const FT_GlyphSlotRec& glyph = *face_->glyph;
    GlyphMask mask{glyph.bitmap_left,
                   glyph.bitmap_top,
                   static_cast<int>(glyph.bitmap.width),
                   static_cast<int>(glyph.bitmap.rows),
                   static_cast<int>(std::lround(static_cast<double>(glyph.advance.x) / 64)),
                   {}};
    for (int row = 0; row < mask.height; ++row) {
      const unsigned char* begin = glyph.bitmap.buffer + std::ptrdiff_t{row} * glyph.bitmap.pitch;
      mask.coverage.insert(mask.coverage.end(), begin, begin + mask.width);
    }
    return mask;
  }

  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
  std::map<std::pair<char32_t, FT_F26Dot6>, GlyphMask> masks_;
};

/// FreeType allows one thread per library object.
Font& font() {
  thread_local Font loaded;
  return loaded;
}

/// Calls `use` with each character and its start in pixels from the left edge of the text. Returns the right
/// edge.
template <class Use>
int walk_along(std::string_view text, const Letters& letters, const Use& use) {
  int x = 0, right = 0;
  bool is_first = true;
  while (!text.empty()) {
    const auto [code, bytes] = first_character(text);
    text.remove_prefix(bytes);
    const GlyphMask& mask = font().mask_of(code, letters.size_px);
    if (std::exchange(is_first, false)) x = -mask.left;
    use(mask, x);
    right = x + (mask.width > 0 ? mask.left + mask.width : mask.advance);
    x += mask.advance;
  }
  return right;
}

}  // namespace

int Letters::capital_height() const { return font().mask_of(U'H', size_px).above; }

int Letters::descent() const {
  const GlyphMask& mask = font().mask_of(U'g', size_px);
  return mask.height - mask.above;
}

int Letters::line_distance() const { return static_cast<int>(std::lround(1.4 * size_px)); }

void require_font() { font_file(); }

double letter_size_for(std::uint32_t picture_height) { return std::max(11.0, 0.025 * picture_height); }

int text_width(std::string_view text, const Letters& letters) {
  return walk_along(text, letters, [](const GlyphMask&, int) {});
}

void draw_text(Picture& picture, std::string_view text, int x, int baseline, const Letters& letters) {
  walk_along(text, letters, [&](const GlyphMask& mask, int from_start) {
    auto covered = mask.coverage.begin();
    for (int row = 0; row < mask.height; ++row)
      for (int column = 0; column < mask.width; ++column, ++covered)
        if (*covered > 0)
          fill(picture, {x + from_start + mask.left + column, baseline - mask.above + row, 1, 1},
               letters.colour, *covered);
  });
}

std::string shortened(std::string_view text, int width, const Letters& letters) {
  if (text_width(text, letters) <= width) return std::string(text);
  std::string fitting;
  for (std::size_t end = 0; end < text.size(); end += first_character(text.substr(end)).bytes) {
    const std::string candidate = std::string(text.substr(0, end)) + "…";
    if (text_width(candidate, letters) > width) break;
    fitting = candidate;
  }
  return fitting;
}

}  // namespace mssim
