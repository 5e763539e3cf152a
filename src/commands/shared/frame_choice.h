#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Which frames of a trace a command takes: --frames or --time, or neither.
struct FrameOptions {
  std::vector<std::string> frames;
  std::optional<double> time_s;

  bool given() const { return time_s || !frames.empty(); }
};

/// Declares --frames and --time; returns the latter. `options` must outlive the parsing.
Argument declare_frames(Arguments& arguments, FrameOptions& options);

/// Those frames, by numbers, of a trace whose frames have these times; all where neither option is given.
/// Throws UsageError.
std::vector<std::size_t> chosen_frames(const FrameOptions& options, const std::vector<double>& times_s);

/// What --frames says: frame numbers from 0 on and ranges of them, separated by commas, and `last`: for
/// example "0,10-20,last"; or `all` alone. Throws UsageError, also for a frame that a trace of `frames`
/// frames does not have.
std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames);

/// The frame nearest to a time, s. Throws UsageError for a time that lies more than half a frame beyond them.
std::size_t frame_at(double time_s, const std::vector<double>& times_s);

}  // namespace mssim
