#include "picture/picture.h"

#include <fmt/core.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <exception>
#include <stdexcept>

#include "picture/lettering.h"

namespace mssim {
namespace {

struct PixelRange {
  std::int64_t begin, end;
};

/// The part of `count` pixels from `first` on that lies within 0 to `size`.
PixelRange pixels_inside(std::int64_t first, std::int64_t count, std::int64_t size) {
  return {std::clamp<std::int64_t>(first, 0, size), std::clamp<std::int64_t>(first + count, 0, size)};
}

/// libpng's last error message.
using PngMessage = std::array<char, 200>;

[[noreturn]] void give_up(png_structp png, png_const_charp text) {
  auto& message = *static_cast<PngMessage*>(png_get_error_ptr(png));
  std::strncpy(message.data(), text, message.size() - 1);
  png_longjmp(png, 1);
}

void append_bytes(png_structp png, png_bytep data, std::size_t size) {
  bool appended = false;
  try {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
    appended = true;
  } catch (const std::exception&) {  // Exceptions must not pass through libpng, which is C.
  }
  if (!appended) png_error(png, "out of memory");
}

/// libpng's structures, freed by the destructor.
struct PngWriter {
  PngMessage message{};
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, give_up, [](png_structp, png_const_charp) {});
  png_infop info = png ? png_create_info_struct(png) : nullptr;

  PngWriter() = default;
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

/// Whether libpng wrote everything. On an error it returns here by longjmp, so no variable in between may
/// have a destructor.
bool write_png(png_structp png, png_infop info, const Picture& picture) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_IHDR(png, info, picture.width, picture.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  // On frames of 640 x 480 pixels of a shaded, coloured surface with lines, level 3 takes 5 ms for 52 KiB;
  // level 1 4 ms for 55, level 4 7.6 ms for 46, level 6 12 ms for 43. Without filters it is 3 ms and 100 KiB;
  // all filters take longer for no fewer bytes.
  png_set_compression_level(png, 3);
  png_set_compression_strategy(png, Z_DEFAULT_STRATEGY);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB | PNG_FILTER_UP);
  png_write_info(png, info);
  static_assert(sizeof(Rgb) == 3);
  for (std::uint32_t y = 0; y < picture.height; ++y)
    png_write_row(png, reinterpret_cast<png_const_bytep>(&picture.at(0, y)));
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

double srgb_code(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

double srgb_light(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

Picture::Picture(std::uint32_t w, std::uint32_t h, Rgb colour)
    : width(w), height(h), pixels(std::size_t{w} * h, colour) {}

void fill(Picture& picture, const PixelBox& box, Rgb colour, std::uint8_t coverage) {
  const PixelRange columns = pixels_inside(box.left, box.width, picture.width);
  const PixelRange rows = pixels_inside(box.top, box.height, picture.height);
  for (std::int64_t y = rows.begin; y < rows.end; ++y)
    for (std::int64_t x = columns.begin; x < columns.end; ++x) {
      Rgb& pixel = picture.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      pixel = blended(pixel, colour, coverage);
    }
}

void paste(Picture& picture, const Picture& pasted, int left, int top) {
  const PixelRange columns = pixels_inside(left, pasted.width, picture.width);
  const PixelRange rows = pixels_inside(top, pasted.height, picture.height);
  if (columns.begin == columns.end) return;
  for (std::int64_t y = rows.begin; y < rows.end; ++y)
    std::copy_n(
        &pasted.at(static_cast<std::uint32_t>(columns.begin - left), static_cast<std::uint32_t>(y - top)),
        columns.end - columns.begin,
        &picture.at(static_cast<std::uint32_t>(columns.begin), static_cast<std::uint32_t>(y)));
}

std::string png_of(const Picture& picture) {
  PngWriter writer;
  if (!writer.info) throw std::runtime_error("no memory to write a PNG picture");
  std::string bytes;
  png_set_write_fn(writer.png, &bytes, append_bytes, [](png_structp) {});
  if (!write_png(writer.png, writer.info, picture))
    throw std::runtime_error(fmt::format("a picture of {} x {} pixels cannot be written as PNG: {}",
                                         picture.width, picture.height, writer.message.data()));
  return bytes;
}

Picture sheet_of(std::span<const CaptionedPicture> pictures, std::uint32_t columns) {
  if (pictures.empty() || columns == 0)
    throw std::invalid_argument("a sheet must have at least one picture and one column");
  const std::uint32_t width = pictures.front().picture.width, height = pictures.front().picture.height;
  for (const CaptionedPicture& cell : pictures)
    if (cell.picture.width != width || cell.picture.height != height)
      throw std::invalid_argument("the pictures of a sheet must have the same size");

  const auto count = static_cast<std::uint32_t>(pictures.size());
  columns = std::min(columns, count);
  const std::uint32_t rows = (count + columns - 1) / columns;
  // Pages scale a sheet to their width, however many pictures it has.
  constexpr double of_sheet = 0.017;
  const Letters letters{std::max(letter_size_for(height), of_sheet * columns * width), Rgb{32, 34, 40}};
  const auto margin = static_cast<std::uint32_t>(std::lround(letters.size_px));
  const bool captioned =
      std::ranges::any_of(pictures, [](const auto& cell) { return !cell.caption.empty(); });
  const auto capital = static_cast<std::uint32_t>(captioned ? letters.capital_height() : 0);
  // Half a margin between a picture and its caption.
  const std::uint32_t caption_height =
      captioned ? margin / 2 + capital + static_cast<std::uint32_t>(letters.descent()) : 0;
  const std::uint32_t column_width = width + margin, row_height = height + caption_height + margin;
  Picture sheet(columns * column_width + margin, rows * row_height + margin);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto left = static_cast<int>(margin + i % columns * column_width);
    const auto top = static_cast<int>(margin + i / columns * row_height);
    paste(sheet, pictures[i].picture, left, top);
    const std::string caption = shortened(pictures[i].caption, static_cast<int>(width), letters);
    const int middle = left + static_cast<int>(width / 2);
    draw_text(sheet, caption, middle - text_width(caption, letters) / 2,
              top + static_cast<int>(height + margin / 2 + capital), letters);
  }
  return sheet;
}

}  // namespace mssim
