#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace mssim {

/// Tells on stderr how far a bench is: on a terminal one line that is written over, with the time left; else
/// a line where a scene begins, so that a log stays short.
class ProgressLine {
 public:
  explicit ProgressLine(std::size_t scenes);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  void begin_scene(const std::string& name);
  /// `done`: share of the scene, 0 to 1.
  void update(const std::string& activity, double done);

 private:
  std::size_t scenes_, begun_ = 0;
  std::string scene_;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace mssim
