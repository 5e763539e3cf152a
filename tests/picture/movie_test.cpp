#include "picture/movie.h"

#include <gmock/gmock.h>
#include <webp/demux.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace mssim {
namespace {

/// What libwebp reads of a movie.
struct ReadMovie {
  WebPAnimInfo info{};
  std::vector<Picture> frames;
  std::vector<int> ends_ms;  ///< when each frame is over
};

ReadMovie read(const std::string& bytes) {
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
      WebPAnimDecoderNew(&data, nullptr), WebPAnimDecoderDelete);
  ReadMovie movie;
  if (!decoder || !WebPAnimDecoderGetInfo(decoder.get(), &movie.info)) {
    ADD_FAILURE() << "no WebP";
    return movie;
  }
  while (WebPAnimDecoderHasMoreFrames(decoder.get())) {
    std::uint8_t* rgba = nullptr;
    int end_ms = 0;
    EXPECT_TRUE(WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms));
    Picture& frame = movie.frames.emplace_back(movie.info.canvas_width, movie.info.canvas_height);
    for (std::size_t i = 0; i < frame.pixels.size(); ++i)
      frame.pixels[i] = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]};
    movie.ends_ms.push_back(end_ms);
  }
  return movie;
}

/// A picture with a smooth run of colours, other ones for each `seed`.
Picture smooth_picture(std::uint32_t width, std::uint32_t height, unsigned seed) {
  Picture picture(width, height);
  for (unsigned y = 0; y < height; ++y)
    for (unsigned x = 0; x < width; ++x)
      picture.at(x, y) = {static_cast<std::uint8_t>(255 * x / width),
                          static_cast<std::uint8_t>(255 * y / height), static_cast<std::uint8_t>(60 * seed)};
  return picture;
}

std::vector<int> ends_at(double frames_per_second) {
  Movie movie(frames_per_second);
  for (unsigned frame = 0; frame < 4; ++frame) movie.add(smooth_picture(16, 16, frame));
  return read(movie.take_bytes()).ends_ms;
}

TEST(Movie, HoldsEveryFrameAndRepeatsForEver) {
  Movie movie(25);
  for (unsigned frame = 0; frame < 4; ++frame) movie.add(smooth_picture(301, 203, frame));
  const ReadMovie found = read(movie.take_bytes());
  EXPECT_EQ(found.info.loop_count, 0U) << "for ever";
  ASSERT_EQ(found.frames.size(), 4U);
  for (unsigned frame = 0; frame < 4; ++frame) {
    const Picture wanted = smooth_picture(301, 203, frame);
    ASSERT_EQ(found.frames[frame].pixels.size(), wanted.pixels.size());
    double difference = 0;
    for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
      const Rgb a = wanted.pixels[i], b = found.frames[frame].pixels[i];
      difference += std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue);
    }
    EXPECT_LT(difference / static_cast<double>(3 * wanted.pixels.size()), 2) << "levels, of frame " << frame;
  }
}

TEST(Movie, RunsAtItsSpeed) {
  EXPECT_THAT(ends_at(30), testing::ElementsAre(33, 67, 100, 133)) << "no rounding adds up";
  EXPECT_THAT(ends_at(1000), testing::ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(ends_at(0.1), testing::ElementsAre(10'000, 20'000, 30'000, 40'000));
  for (const double wrong : {0.0, -1.0, 0.09, 1001.0, std::nan("")})
    EXPECT_THROW(Movie{wrong}, std::invalid_argument) << wrong;
}

TEST(Movie, IsTheSameEachTime) {
  const auto bytes = [] {
    Movie movie(10);
    for (unsigned frame = 0; frame < 3; ++frame) movie.add(smooth_picture(64, 48, frame));
    return movie.take_bytes();
  };
  EXPECT_EQ(bytes(), bytes());
}

TEST(Movie, RefusesWhatIsNone) {
  EXPECT_THROW(Movie(10).take_bytes(), std::logic_error);
  EXPECT_THROW(Movie(10).add(Picture()), std::runtime_error);
  EXPECT_THROW(Movie(10).add(Picture(20'000, 1)), std::runtime_error);
  Movie movie(10);
  movie.add(Picture(4, 4));
  EXPECT_THROW(movie.add(Picture(4, 5)), std::invalid_argument);
  EXPECT_NE(movie.take_bytes(), "");
  EXPECT_THROW(movie.take_bytes(), std::logic_error);
}

}  // namespace
}  // namespace mssim
