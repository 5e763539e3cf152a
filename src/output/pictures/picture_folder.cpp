#include "output/pictures/picture_folder.h"

#include <string>
#include <system_error>
#include <utility>

#include "picture/png.h"
#include "platform/files.h"

namespace mssim {
namespace {

std::string picture_name(std::size_t number) {
  constexpr std::size_t digits = 6;  // so that listings have them in order
  const std::string text = std::to_string(number);
  return "frame-" + std::string(text.size() < digits ? digits - text.size() : 0, '0') + text + ".png";
}

}  // namespace

PictureFolder::PictureFolder(std::filesystem::path folder, TraceContent content,
                             const PictureOptions& options)
    : folder_(std::move(folder)),
      lock_(make_folder(folder_)),
      content_(std::move(content)),
      options_(options) {
  std::error_code error;
  if (!std::filesystem::is_empty(folder_, error) || error)
    throw WriteError("cannot put pictures into " + folder_.string() +
                     ", which is not empty; empty it or choose another folder");
}

void PictureFolder::draw(const std::vector<Vec3d>& positions) {
  if (!painter_) painter_.emplace(content_, positions, options_);
  painter_->make_room_for(positions);
  write_file_atomically(folder_ / picture_name(pictures_), png_of(painter_->picture_of(positions)));
  ++pictures_;
}

}  // namespace mssim
