#include "commands/render/frame_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "commands/shared/exit_code.h"
#include "text/decimal.h"
#include "text/number_in.h"
#include "text/printable.h"

namespace mssim {
namespace {

std::size_t frame_number(const std::string& word, std::size_t frames) {
  if (word == "last") return frames - 1;
  const auto number = number_in<std::int64_t>(word);
  if (!number || *number < 0)
    throw UsageError("--frames: \"" + printable(word) +
                     "\" is no frame; give numbers from 0 on, ranges like 10-20, or last");
  if (static_cast<std::uint64_t>(*number) >= frames)
    throw UsageError("--frames: there is no frame " + std::to_string(*number) + "; the last one is " +
                     std::to_string(frames - 1));
  return static_cast<std::size_t>(*number);
}

}  // namespace

std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames) {
  std::vector<std::size_t> list;
  for (const std::string& word : words) {
    const std::size_t dash = word.find('-', 1);
    const std::size_t first = frame_number(word.substr(0, dash), frames);
    const std::size_t last = dash == std::string::npos ? first : frame_number(word.substr(dash + 1), frames);
    if (last < first) throw UsageError("--frames: \"" + printable(word) + "\" ends before it begins");
    for (std::size_t frame = first; frame <= last; ++frame) list.push_back(frame);
  }
  return list;
}

std::size_t frame_at(double time_s, const std::vector<double>& times_s) {
  const auto nearest = std::ranges::min_element(
      times_s, {}, [&](double frame_time_s) { return std::abs(frame_time_s - time_s); });
  const double spacing = times_s.size() < 2 ? 0 : times_s.back() - times_s[times_s.size() - 2];
  if (time_s > times_s.back() + spacing)
    throw UsageError("--time: " + decimal(time_s) + " s is after the last frame, at " +
                     decimal(times_s.back()) + " s");
  return static_cast<std::size_t>(nearest - times_s.begin());
}

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
