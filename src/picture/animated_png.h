#pragma once

#include <cstdint>
#include <string>

#include "picture/picture.h"

namespace mssim {

/// An animated PNG (APNG, part of PNG's third edition) that repeats for ever, made frame by frame. It holds
/// the compressed frames only. Programs that do not know animations show the first frame.
class AnimatedPng {
 public:
  /// Each frame is shown for 1 / `frames_per_second`, as near as the file can say: it states a fraction of
  /// two numbers below 65,536. Throws std::invalid_argument unless it is between 0.1 and 1000.
  explicit AnimatedPng(double frames_per_second);

  /// Throws std::runtime_error for a picture that `png_of` refuses, and std::invalid_argument for one of
  /// another size than the first one's.
  void add(const Picture& frame);

  std::uint32_t frames() const { return frames_; }

  /// The bytes of the file with all frames added so far. Throws std::logic_error if there are none.
  std::string bytes() const;

 private:
  void append_frame_control();

  std::uint16_t delay_numerator_ = 0, delay_denominator_ = 0;
  std::uint32_t width_ = 0, height_ = 0, frames_ = 0;
  /// The number that the next chunk of the animation bears: they are counted through all frames.
  std::uint32_t sequence_number_ = 0;
  /// The file before the chunk that says how many frames there are, and what follows that chunk.
  std::string head_, frame_chunks_;
};

}  // namespace mssim
