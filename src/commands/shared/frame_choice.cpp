#include "commands/shared/frame_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

std::size_t frame_number(const std::string& word, std::size_t frames) {
  if (word == "last") return frames - 1;
  const auto number = number_in<std::int64_t>(word);
  if (!number || *number < 0)
    throw UsageError("--frames: \"" + printable(word) +
                     "\" is no frame; give numbers from 0 on, ranges like 10-20, last, or all");
  if (static_cast<std::uint64_t>(*number) >= frames)
    throw UsageError("--frames: there is no frame " + std::to_string(*number) + "; the last one is " +
                     std::to_string(frames - 1));
  return static_cast<std::size_t>(*number);
}

std::vector<std::size_t> all_of(std::size_t frames) {
  std::vector<std::size_t> list(frames);
  std::iota(list.begin(), list.end(), std::size_t{0});
  return list;
}

}  // namespace

Argument declare_frames(Arguments& arguments, FrameOptions& options) {
  Argument time = arguments.add_number("--time", options.time_s,
                                       "Take the frame nearest to this time (default: the last frame)",
                                       number_between(0, 1e9));
  time.value_name("SECONDS");
  arguments
      .add_list("--frames", options.frames,
                "Take these frames only: numbers from 0 on, ranges like 10-20, last, all")
      .value_name("LIST")
      .excludes(time);
  return time;
}

std::vector<std::size_t> chosen_frames(const FrameOptions& options, const std::vector<double>& times_s) {
  if (options.time_s) return {frame_at(*options.time_s, times_s)};
  return options.frames.empty() ? all_of(times_s.size()) : listed_frames(options.frames, times_s.size());
}

std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames) {
  std::vector<std::size_t> list;
  if (words == std::vector<std::string>{"all"}) return all_of(frames);
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

}  // namespace mssim
