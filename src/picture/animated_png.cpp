#include "picture/animated_png.h"

#include <zlib.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "picture/png.h"

namespace mssim {
namespace {

constexpr std::size_t signature_size = 8;

void append_number(std::string& bytes, std::uint32_t number, int size) {
  for (int byte = size - 1; byte >= 0; --byte) bytes += static_cast<char>(number >> (8 * byte) & 0xff);
}

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (const char byte : bytes.substr(at, 4)) number = number << 8 | static_cast<unsigned char>(byte);
  return number;
}

/// A chunk is the size of its data, its type, the data, and a checksum of the latter two.
void append_chunk(std::string& bytes, std::string_view type, std::string_view data) {
  append_number(bytes, static_cast<std::uint32_t>(data.size()), 4);
  const std::size_t checked_from = bytes.size();
  bytes.append(type).append(data);
  append_number(bytes,
                static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(&bytes[checked_from]),
                                                   bytes.size() - checked_from)),
                4);
}

struct PngParts {
  std::string_view before_image;             ///< signature and chunks
  std::vector<std::string_view> image_data;  ///< the data of each IDAT chunk
};

PngParts parts_of(std::string_view png) {
  PngParts parts;
  for (std::size_t at = signature_size; at < png.size();) {
    const std::size_t size = number_at(png, at);
    if (png.substr(at + 4, 4) == "IDAT") {
      if (parts.image_data.empty()) parts.before_image = png.substr(0, at);
      parts.image_data.push_back(png.substr(at + 8, size));
    }
    at += size + 12;
  }
  return parts;
}

}  // namespace

AnimatedPng::AnimatedPng(double frames_per_second) {
  if (!(frames_per_second >= 0.1 && frames_per_second <= 1000))
    throw std::invalid_argument("an animation has between 0.1 and 1000 frames a second");
  // As many digits as fit. No more than 1000, so that 1 / 30 or 100 / 2997 stay such.
  unsigned numerator = 1000;
  while (frames_per_second * numerator > 65535) numerator /= 10;
  const auto denominator = std::max(1u, static_cast<unsigned>(std::lround(frames_per_second * numerator)));
  const unsigned divisor = std::gcd(numerator, denominator);
  delay_numerator_ = static_cast<std::uint16_t>(numerator / divisor);
  delay_denominator_ = static_cast<std::uint16_t>(denominator / divisor);
}

void AnimatedPng::append_frame_control() {
  std::string control;
  append_number(control, sequence_number_++, 4);
  append_number(control, width_, 4);
  append_number(control, height_, 4);
  append_number(control, 0, 4);  // left
  append_number(control, 0, 4);  // top
  append_number(control, delay_numerator_, 2);
  append_number(control, delay_denominator_, 2);
  append_number(control, 0, 1);  // the frame is left as it is before the next one
  append_number(control, 0, 1);  // it replaces what was there
  append_chunk(frame_chunks_, "fcTL", control);
}

void AnimatedPng::add(const Picture& frame) {
  if (frames_ > 0 && (frame.width != width_ || frame.height != height_))
    throw std::invalid_argument("the frames of an animation have one size");
  const std::string png = png_of(frame);
  const PngParts parts = parts_of(png);
  if (frames_ == 0) {
    head_ = parts.before_image;
    width_ = frame.width;
    height_ = frame.height;
  }
  append_frame_control();
  for (const std::string_view data : parts.image_data) {
    if (frames_ == 0) {
      append_chunk(frame_chunks_, "IDAT", data);
    } else {
      std::string numbered;
      append_number(numbered, sequence_number_++, 4);
      append_chunk(frame_chunks_, "fdAT", numbered.append(data));
    }
  }
  ++frames_;
}

std::string AnimatedPng::bytes() const {
  if (frames_ == 0) throw std::logic_error("an animation has at least one frame");
  std::string bytes = head_, control;
  append_number(control, frames_, 4);
  append_number(control, 0, 4);  // for ever
  append_chunk(bytes, "acTL", control);
  bytes += frame_chunks_;
  append_chunk(bytes, "IEND", {});
  return bytes;
}

}  // namespace mssim
