#include "commands/render/sheet_choice.h"

#include "text/number_in.h"

namespace mssim {

std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count) {
  if (frames.size() <= count) return frames;
  if (count == 1) return {frames.back()};
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(frames[(i * (frames.size() - 1) + (count - 1) / 2) / (count - 1)]);
  return chosen;
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
