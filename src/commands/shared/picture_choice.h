#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "commands/arguments/arguments.h"
#include "output/pictures/painter.h"

namespace mssim {

/// Size of pictures that are written one by one.
inline constexpr const char* usual_picture_size = "960x720";

/// How pictures are to look, in the words of the command line.
struct PictureChoice {
  std::string view = "three-quarter";
  std::string size;  ///< empty: as large as is usual
  ColourBy colour = ColourBy::object;
};

/// Declares --view, --size and --colour. `usual_size` is what --help says of sizes that are not given. Where
/// `needed` is given, each is an error without it. `choice` must outlive the parsing.
void declare_pictures(Arguments& arguments, PictureChoice& choice, const std::string& usual_size,
                      std::optional<Argument> needed = {});

/// The choice as options, drawn by so many threads. `usual_size` is WIDTHxHEIGHT. Throws UsageError.
PictureOptions picture_options(const PictureChoice& choice, const std::string& usual_size, int threads);

/// "WIDTHxHEIGHT" as two whole numbers from 1 to `most`; none where it is something else.
std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text, std::uint32_t most);

}  // namespace mssim
