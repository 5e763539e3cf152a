#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "picture/picture.h"

struct WebPAnimEncoder;  // in libwebp

namespace mssim {

/// An animated WebP that repeats for ever, made frame by frame; only compressed frames are stored. The same
/// frames give the same bytes with the same libwebp.
class Movie {
 public:
  /// Frame i is shown from time i / `frames_per_second` on, rounded to milliseconds. Throws
  /// std::invalid_argument unless there are 0.1 to 1000 frames per second.
  explicit Movie(double frames_per_second);

  /// Throws std::runtime_error for a picture that libwebp refuses (one without pixels, or more than 16,383
  /// across), and std::invalid_argument if its size differs from that of the first frame.
  void add(const Picture& frame);

  /// The bytes of the file. Ends the movie: no other call is allowed after it. Throws std::logic_error
  /// if there are no frames.
  std::string take_bytes();

 private:
  int milliseconds_at(std::uint32_t frame) const;

  double frames_per_second_;
  std::uint32_t width_ = 0, height_ = 0, frames_ = 0;
  std::unique_ptr<WebPAnimEncoder, void (*)(WebPAnimEncoder*)> encoder_;
};

}  // namespace mssim
