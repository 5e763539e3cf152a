#include "picture/animated_png.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "picture/png.h"
#include "tests/support/png_fixture.h"

namespace mssim {
namespace {

std::string types_of(const std::vector<PngChunk>& chunks) {
  std::string types;
  for (const PngChunk& chunk : chunks) types += chunk.type + ' ';
  return types;
}

/// The delay of the first frame as numerator / denominator.
std::string delay_at(double frames_per_second) {
  AnimatedPng animation(frames_per_second);
  animation.add(Picture(1, 1));
  for (const PngChunk& chunk : chunks_of(animation.bytes()))
    if (chunk.type == "fcTL")
      return std::to_string(png_number(chunk.data, 20, 2)) + "/" +
             std::to_string(png_number(chunk.data, 22, 2));
  return "";
}

/// A PNG of one frame, made of the header and that frame's data alone.
Picture frame_of(const std::vector<PngChunk>& chunks, std::size_t wanted) {
  std::string png = "\x89PNG\r\n\x1a\n";
  const auto append = [&](const std::string& type, const std::string& data) {
    const auto number = [&](unsigned long value) {
      for (int byte = 3; byte >= 0; --byte) png += static_cast<char>(value >> (8 * byte) & 0xff);
    };
    number(data.size());
    const std::string checked = type + data;
    png += checked;
    number(crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size())));
  };
  append("IHDR", chunks.front().data);
  std::size_t frames = 0;
  for (const PngChunk& chunk : chunks) {
    if (chunk.type == "fcTL") ++frames;
    if (frames != wanted + 1) continue;
    if (chunk.type == "IDAT") append("IDAT", chunk.data);
    if (chunk.type == "fdAT") append("IDAT", chunk.data.substr(4));
  }
  append("IEND", "");
  return decoded(png);
}

TEST(AnimatedPng, HasTheChunksOfItsFramesInOrder) {
  AnimatedPng animation(25);
  for (unsigned frame = 0; frame < 3; ++frame) animation.add(coloured_picture(12, 9, frame));
  EXPECT_EQ(animation.frames(), 3u);
  const std::vector<PngChunk> chunks = chunks_of(animation.bytes());
  EXPECT_EQ(types_of(chunks), "IHDR sRGB acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
  std::uint32_t number = 0;
  for (const PngChunk& chunk : chunks) {
    EXPECT_TRUE(chunk.sound) << chunk.type;
    if (chunk.type == "acTL") {
      EXPECT_EQ(png_number(chunk.data, 0, 4), 3u);
      EXPECT_EQ(png_number(chunk.data, 4, 4), 0u) << "for ever";
    }
    if (chunk.type == "fcTL") {
      ASSERT_EQ(chunk.data.size(), 26u);
      EXPECT_EQ(png_number(chunk.data, 4, 4), 12u);
      EXPECT_EQ(png_number(chunk.data, 8, 4), 9u);
      EXPECT_EQ(chunk.data.substr(12, 8), std::string(8, '\0'));
      EXPECT_EQ(chunk.data.substr(24), std::string(2, '\0'));
    }
    if (chunk.type == "fcTL" || chunk.type == "fdAT") {
      EXPECT_EQ(png_number(chunk.data, 0, 4), number++);
    }
  }
}

TEST(AnimatedPng, ShowsItsFirstFrameToProgramsThatKnowNoAnimations) {
  AnimatedPng animation(25);
  for (unsigned frame = 0; frame < 2; ++frame) animation.add(coloured_picture(12, 9, frame));
  EXPECT_EQ(decoded(animation.bytes()), decoded(png_of(coloured_picture(12, 9, 0))));
}

TEST(AnimatedPng, HoldsEveryFrameAlsoInSeveralChunks) {
  AnimatedPng animation(25);
  for (unsigned frame = 0; frame < 3; ++frame) animation.add(coloured_picture(301, 203, 17 * frame));
  const std::vector<PngChunk> chunks = chunks_of(animation.bytes());
  EXPECT_GT(std::ranges::count(chunks, "fdAT", &PngChunk::type), 2);
  for (unsigned frame = 0; frame < 3; ++frame)
    EXPECT_EQ(frame_of(chunks, frame), coloured_picture(301, 203, 17 * frame)) << frame;
}

TEST(AnimatedPng, CanBeAskedForItsBytesAtAnyTime) {
  AnimatedPng animation(10);
  EXPECT_THROW(animation.bytes(), std::logic_error);
  animation.add(coloured_picture(4, 4, 1));
  const std::string one = animation.bytes();
  EXPECT_EQ(one, animation.bytes());
  animation.add(coloured_picture(4, 4, 2));
  EXPECT_GT(animation.bytes().size(), one.size());
}

TEST(AnimatedPng, StatesDelaysAsFractions) {
  EXPECT_EQ(delay_at(30), "1/30");
  EXPECT_EQ(delay_at(12.5), "2/25");
  EXPECT_EQ(delay_at(29.97), "100/2997");
  EXPECT_EQ(delay_at(1000), "1/1000");
  EXPECT_EQ(delay_at(0.1), "10/1");
  for (const double wrong : {0.0, -1.0, 0.09, 1001.0, std::nan("")}) {
    EXPECT_THROW(AnimatedPng{wrong}, std::invalid_argument) << wrong;
  }
}

TEST(AnimatedPng, RefusesFramesOfAnotherSize) {
  AnimatedPng animation(10);
  animation.add(Picture(4, 4));
  EXPECT_THROW(animation.add(Picture(4, 5)), std::invalid_argument);
  EXPECT_THROW(AnimatedPng(10).add(Picture()), std::runtime_error);
  EXPECT_EQ(animation.frames(), 1u);
}

}  // namespace
}  // namespace mssim
