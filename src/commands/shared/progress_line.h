#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace mssim {

/// Tells on stderr how far a bench is: on a terminal one line that is written over, with the time left; else
/// a line where a scene begins, so that a log stays short.
class ProgressLine {
 public:
  /// What a log, which is no terminal, is told.
  enum class Log : std::uint8_t { scenes, nothing };

  explicit ProgressLine(std::size_t scenes, Log log = Log::scenes);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  void begin_scene(const std::string& name);
  /// `done`: share of the scene, 0 to 1.
  void update(const std::string& activity, double done);
  /// The same for who calls all the time: ten times a second at most.
  void update_often(const std::string& activity, double done);

 private:
  std::size_t scenes_, begun_ = 0;
  std::string scene_;
  bool terminal_, logs_scenes_;
  std::chrono::steady_clock::time_point start_, shown_;
};

}  // namespace mssim
