#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/process.h"

namespace mssim {

/// How far a command is.
struct Progress {
  std::string scene;
  std::size_t number = 1, scenes = 1;  ///< which of how many scenes
  std::string activity;
  double fraction = 0;                 ///< of the whole, 0 to 1
  std::optional<double> seconds_left;  ///< none while nobody knows
};

/// One line that fits a terminal of `width` columns: "SCENE (1 of 2)  [####  ]  about 0:12 left  ACTIVITY".
/// In a narrow one a percentage stands for the bar, and the end of a long activity is left out. The places do
/// not depend on the activity, so that a reader's eye can rest on them.
std::string progress_text(const Progress& progress, int width, bool utf8);

/// Tells on stderr how far a bench is: on a terminal one line that is written over, with the time left; else
/// a line where a scene begins, so that a log stays short.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;
  /// What a log, which is no terminal, is told.
  enum class Log : std::uint8_t { scenes, nothing };

  /// `weights`: of each scene, in proportion to the time that it takes. `end`: when all will have ended at
  /// the latest.
  explicit ProgressLine(std::vector<double> weights, Log log = Log::scenes,
                        std::optional<Clock::time_point> end = {});
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  /// Wipes the line, too: what is to be known of a scene may be told now.
  void begin_scene(const std::string& name);
  /// The scene that has begun takes no time.
  void skip_scene();
  /// `done`: share of the scene, 0 to 1.
  void update(const std::string& activity, double done);
  /// Updates ten times a second at most, for who calls all the time.
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

/// Says the first few of these on stderr, in a line each, and how many more there are.
void tell_first(const std::vector<std::string>& sentences);

/// Says on stderr, once in a process, what the drivers of OpenCL devices lack. For a command that uses such a
/// device: it asks the drivers (backends/devices/drivers.h).
void tell_of_opencl();

/// While it lives, a first ending signal (platform/process.h) is remembered, and told on stderr, so
/// that what is under way can be finished and written; a second one ends the program at once. Signals that
/// are ignored (nohup) stay so. One at a time.
class StopRequest {
 public:
  StopRequest();
  /// A signal that nobody asked for ends the program now.
  ~StopRequest();

  /// Whether a signal has come.
  bool requested() const { return noted_ending_signal() != 0; }
  /// Throws Interrupted when one has.
  void throw_if_requested() { throw_if_ending_signal_noted(); }

 private:
  EndingSignals signals_;
};

}  // namespace mssim
