#include "picture/glyphs.h"

#include <algorithm>

#include "picture/glyph_table.h"

namespace mssim {

const Glyph& glyph_of(char32_t character) {
  static constexpr Glyph box{0, 14, "M 0 0 L 0 26 L 14 26 L 14 0 L 0 0"};
  for (const auto table : {letter_glyphs, sign_glyphs}) {
    const auto found = std::ranges::lower_bound(table, character, {}, &Glyph::character);
    if (found != table.end() && found->character == character) return *found;
  }
  return box;
}

}  // namespace mssim
