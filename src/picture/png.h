#pragma once

#include <string>

#include "picture/picture.h"

namespace mssim {

/// The bytes of a PNG file of `picture`: 8 bits a channel, sRGB, no alpha. The same picture gives the same
/// bytes with the same libpng and zlib. Throws std::runtime_error for a picture without pixels or one that
/// libpng refuses.
std::string png_of(const Picture& picture);

}  // namespace mssim
