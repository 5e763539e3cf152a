#pragma once

#include <fmt/core.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/process.h"

namespace mssim {

/// Progress of a command.
struct Progress {
  std::string scene;
  std::size_t number = 1, scenes = 1;  ///< the present scene, counted from 1, and the number of scenes
  std::string activity;
  double fraction = 0;                 ///< of the whole, 0 to 1
  std::optional<double> seconds_left;  ///< none while unknown
};

/// One line that fits a terminal of `width` columns: "SCENE (1 of 2)  [####  ]  about 0:12 left  ACTIVITY". A
/// narrow terminal gets a percentage instead of the bar, and a truncated activity. Positions do not depend on
/// the activity, so the line is easy to read.
std::string progress_text(const Progress& progress, int width, bool utf8);

/// Reports the progress of a bench on stderr: on a terminal as one line that is overwritten, with the
/// remaining time; otherwise as one line per scene, so that a log stays short.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;
  /// Output if stderr is not a terminal.
  enum class Log : std::uint8_t { scenes, nothing };

  /// `weights`: of each scene, proportional to its time. `end`: latest end of everything.
  explicit ProgressLine(std::vector<double> weights, Log log = Log::scenes,
                        std::optional<Clock::time_point> end = {});
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  /// Begins a scene. Also erases the line, so that messages about the scene can be printed.
  void begin_scene(const std::string& name);
  /// Marks the current scene as taking no time.
  void skip_scene();
  /// `done`: finished share of the scene, 0 to 1.
  void update(const std::string& activity, double done);
  /// Like update, but at most ten times per second, for frequent calls.
  void update_often(const std::string& activity, double done);

 private:
  void wipe() const;
  std::optional<double> seconds_left(double fraction) const;

  std::vector<double> weights_;
  std::size_t begun_ = 0;
  std::string scene_;
  bool rewrites_, logs_scenes_;
  Clock::time_point start_, shown_;
  std::optional<Clock::time_point> end_;
};

/// Prints a sentence to stderr, as the program's. Also takes the arguments of fmt::format().
void tell(const std::string& sentence);
template <class First, class... Values>
void tell(fmt::format_string<First, Values...> sentence, First&& first, Values&&... values) {
  tell(fmt::format(sentence, std::forward<First>(first), std::forward<Values>(values)...));
}

/// Prints the first few sentences to stderr, one per line, and the number of the others.
void tell_first(const std::vector<std::string>& sentences);

/// Prints to stderr, once per process, what the drivers of OpenCL devices lack. Queries the drivers
/// (backends/devices/drivers.h), so only commands that use such a device should call it.
void tell_of_opencl();

/// During its lifetime, a first ending signal (platform/process.h) is noted and reported on stderr, so that
/// current work can be finished and written; a second one ends the program at once. Ignored signals (nohup)
/// stay ignored. Only one may exist at a time.
class StopRequest {
 public:
  StopRequest();
  /// Ends the program if a signal was noted that has not been thrown.
  ~StopRequest();

  /// Whether a signal has come.
  bool requested() const { return noted_ending_signal() != 0; }
  /// Throws Interrupted if a signal has come.
  void throw_if_requested() { throw_if_ending_signal_noted(); }

 private:
  EndingSignals signals_;
};

}  // namespace mssim
