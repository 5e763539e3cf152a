#include "picture/movie.h"

#include <fmt/core.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>
#include <stdexcept>

namespace mssim {
namespace {

WebPConfig quality() {
  WebPConfig config;
  // Lossy, with little loss; method 2 of 6, because higher ones take longer than drawing.
  if (!WebPConfigPreset(&config, WEBP_PRESET_DRAWING, 90))
    throw std::runtime_error("libwebp has another version than the one mssim was built with");
  config.method = 2;
  return config;
}

/// A picture of libwebp, freed by its destructor.
struct WebpPicture {
  WebPPicture picture;

  explicit WebpPicture(const Picture& pixels) {
    static_assert(sizeof(Rgb) == 3);
    const bool made = WebPPictureInit(&picture) != 0;
    picture.use_argb = 1;
    picture.width = static_cast<int>(pixels.width);
    picture.height = static_cast<int>(pixels.height);
    if (!made || pixels.pixels.empty() ||
        !WebPPictureImportRGB(&picture, &pixels.pixels.front().red, 3 * picture.width))
      throw std::runtime_error(
          fmt::format("a picture of {} x {} pixels cannot be written as WebP", pixels.width, pixels.height));
  }
  WebpPicture(const WebpPicture&) = delete;
  WebpPicture& operator=(const WebpPicture&) = delete;
  ~WebpPicture() { WebPPictureFree(&picture); }
};

}  // namespace

Movie::Movie(double frames_per_second)
    : frames_per_second_(frames_per_second), encoder_(nullptr, WebPAnimEncoderDelete) {
  if (!(frames_per_second >= 0.1 && frames_per_second <= 1000))
    throw std::invalid_argument("a movie must have 0.1 to 1000 frames per second");
}

int Movie::milliseconds_at(std::uint32_t frame) const {
  return static_cast<int>(std::lround(1000.0 * frame / frames_per_second_));
}

void Movie::add(const Picture& frame) {
  if (frames_ > 0 && (frame.width != width_ || frame.height != height_))
    throw std::invalid_argument("the frames of a movie must have the same size");
  WebpPicture drawn(frame);
  if (!encoder_) {
    encoder_.reset(WebPAnimEncoderNew(drawn.picture.width, drawn.picture.height, nullptr));
    if (!encoder_) throw std::runtime_error("libwebp cannot make a movie of pictures of this size");
    width_ = frame.width;
    height_ = frame.height;
  }
  const WebPConfig config = quality();
  if (!WebPAnimEncoderAdd(encoder_.get(), &drawn.picture, milliseconds_at(frames_), &config))
    throw std::runtime_error(std::string("libwebp cannot add a frame: ") +
                             WebPAnimEncoderGetError(encoder_.get()));
  ++frames_;
}

std::string Movie::take_bytes() {
  if (!encoder_) throw std::logic_error("a movie needs a frame, and its bytes can be taken only once");
  WebPData data;
  WebPDataInit(&data);
  const bool whole = WebPAnimEncoderAdd(encoder_.get(), nullptr, milliseconds_at(frames_), nullptr) &&
                     WebPAnimEncoderAssemble(encoder_.get(), &data);
  std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
  WebPDataClear(&data);
  if (!whole)
    throw std::runtime_error(std::string("libwebp cannot finish the movie: ") +
                             WebPAnimEncoderGetError(encoder_.get()));
  encoder_.reset();
  return bytes;
}

}  // namespace mssim
