#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mssim {

/// What --frames says: frame numbers from 0 on and ranges of them, separated by commas, and `last`: for
/// example "0,10-20,last". Throws UsageError, also for a frame that a trace of `frames` frames does not have.
std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames);

/// The frame nearest to a time, s. Throws UsageError for a time that lies more than half a frame beyond them.
std::size_t frame_at(double time_s, const std::vector<double>& times_s);

/// `count` of `frames`, evenly spread from the first to the last; all where there are no more.
std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count);

/// "WIDTHxHEIGHT" as two whole numbers from 1 to `most`; none where it is something else.
std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text, std::uint32_t most);

}  // namespace mssim
