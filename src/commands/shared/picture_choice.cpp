#include "commands/shared/picture_choice.h"

#include "text/error.h"
#include "text/text.h"

namespace mssim {

void declare_pictures(Arguments& arguments, PictureChoice& choice, const std::string& usual_size,
                      std::optional<Argument> needed) {
  const auto of_pictures = [&](Argument argument) {
    if (needed) argument.needs(*needed);
  };
  of_pictures(arguments
                  .add("--view", choice.view,
                       "From where: front, side, back, three-quarter, or AZIMUTH,ELEVATION in degrees "
                       "(default: three-quarter)")
                  .value_name("VIEW"));
  of_pictures(
      arguments.add("--size", choice.size, "Size of a picture in pixels (default: " + usual_size + ')')
          .value_name("WIDTHxHEIGHT"));
  of_pictures(arguments.add_choice(
      "--colour", choice.colour,
      {{"object", ColourBy::object}, {"panel", ColourBy::panel}, {"strain", ColourBy::strain}},
      "What colours tell apart: object, panel (of a garment) or strain (default: object)"));
}

PictureOptions picture_options(const PictureChoice& choice, const std::string& usual_size, int threads) {
  const auto view = view_direction(choice.view);
  if (!view)
    throw UsageError("--view: \"" + printable(choice.view) +
                     "\" is no view; give front, side, back, three-quarter, or AZIMUTH,ELEVATION in degrees");
  const auto size = two_numbers(choice.size.empty() ? usual_size : choice.size, most_picture_pixels);
  if (!size)
    throw UsageError("--size: \"" + printable(choice.size) + "\" is no size; give WIDTHxHEIGHT, up to " +
                     std::to_string(most_picture_pixels) + " pixels each");
  return {*view, size->first, size->second, choice.colour, threads};
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text,
                                                                   std::uint32_t most) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto first = number_in<std::int64_t>(std::string(text.substr(0, x)));
  const auto second = number_in<std::int64_t>(std::string(text.substr(x + 1)));
  const auto good = [&](const std::optional<std::int64_t>& n) { return n && *n >= 1 && *n <= most; };
  if (!good(first) || !good(second)) return std::nullopt;
  return std::pair{static_cast<std::uint32_t>(*first), static_cast<std::uint32_t>(*second)};
}

}  // namespace mssim
