#pragma once

#include <span>

#include "picture/glyphs.h"

namespace mssim {

/// Letters and digits, and all else, each in ascending order.
extern const std::span<const Glyph> letter_glyphs, sign_glyphs;

}  // namespace mssim
