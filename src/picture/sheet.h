#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "picture/picture.h"

namespace mssim {

struct CaptionedPicture {
  Picture picture;
  std::string caption;
};

/// The pictures in rows of `columns`, from left to right, each with its caption below it, on white. A row may
/// be incomplete; fewer pictures than columns are one row. A caption wider than its picture is shortened;
/// where all captions are empty, there is no room for them. Throws std::invalid_argument without columns,
/// without pictures, and for pictures of several sizes.
Picture sheet_of(std::span<const CaptionedPicture> pictures, std::uint32_t columns);

}  // namespace mssim
