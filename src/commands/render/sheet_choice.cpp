#include "commands/render/sheet_choice.h"

namespace mssim {

std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count) {
  if (frames.size() <= count) return frames;
  if (count == 1) return {frames.back()};
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(frames[(i * (frames.size() - 1) + (count - 1) / 2) / (count - 1)]);
  return chosen;
}

}  // namespace mssim
