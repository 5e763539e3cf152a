#include "picture/sheet.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "picture/lettering.h"

namespace mssim {

Picture sheet_of(std::span<const CaptionedPicture> pictures, std::uint32_t columns) {
  if (pictures.empty() || columns == 0)
    throw std::invalid_argument("a sheet has at least one picture and one column");
  const std::uint32_t width = pictures.front().picture.width, height = pictures.front().picture.height;
  for (const CaptionedPicture& cell : pictures)
    if (cell.picture.width != width || cell.picture.height != height)
      throw std::invalid_argument("the pictures of a sheet have one size");

  const auto count = static_cast<std::uint32_t>(pictures.size());
  columns = std::min(columns, count);
  const std::uint32_t rows = (count + columns - 1) / columns;
  const Letters letters{letter_size_for(height), Rgb{32, 34, 40}};
  const auto margin = static_cast<std::uint32_t>(std::lround(letters.size_px));
  const auto capital = static_cast<std::uint32_t>(letters.capital_height());
  const bool captioned =
      std::ranges::any_of(pictures, [](const auto& cell) { return !cell.caption.empty(); });
  // Between a picture and its caption: half of a margin.
  const std::uint32_t caption_height =
      captioned ? margin / 2 + capital + static_cast<std::uint32_t>(letters.descent()) : 0;
  const std::uint32_t column_width = width + margin, row_height = height + caption_height + margin;
  Picture sheet(columns * column_width + margin, rows * row_height + margin);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto left = static_cast<int>(margin + i % columns * column_width);
    const auto top = static_cast<int>(margin + i / columns * row_height);
    paste(sheet, pictures[i].picture, left, top);
    draw_text(sheet, shortened(pictures[i].caption, static_cast<int>(width), letters),
              left + static_cast<int>(width / 2), top + static_cast<int>(height + margin / 2 + capital),
              letters, Alignment::centre);
  }
  return sheet;
}

}  // namespace mssim
