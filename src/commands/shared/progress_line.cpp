#include "commands/shared/progress_line.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace mssim {
namespace {

/// minutes:seconds
std::string clock_text(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  char text[32];
  std::snprintf(text, sizeof text, "%d:%02d", whole / 60, whole % 60);
  return text;
}

constexpr const char* clear_line = "\r\033[K";

}  // namespace

ProgressLine::ProgressLine(std::size_t scenes, Log log)
    : scenes_(scenes),
      terminal_(isatty(STDERR_FILENO) != 0),
      logs_scenes_(!terminal_ && log == Log::scenes),
      start_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (terminal_) std::cerr << clear_line << std::flush;
}

void ProgressLine::begin_scene(const std::string& name) {
  scene_ = name;
  ++begun_;
  if (logs_scenes_) std::cerr << "mssim: " << name << " (" << begun_ << " of " << scenes_ << ")\n";
}

void ProgressLine::update_often(const std::string& activity, double done) {
  constexpr std::chrono::milliseconds between_lines{100};
  if (std::chrono::steady_clock::now() - shown_ >= between_lines) update(activity, done);
}

void ProgressLine::update(const std::string& activity, double done) {
  if (!terminal_) return;
  shown_ = std::chrono::steady_clock::now();
  // Scenes take about the same time, whatever their size: samples are so long.
  const double fraction = (static_cast<double>(begun_ - 1) + done) / static_cast<double>(scenes_);
  const double elapsed = std::chrono::duration<double>(shown_ - start_).count();
  std::cerr << clear_line << scene_ << ": " << activity;
  if (fraction > 0.02) std::cerr << ", about " << clock_text(elapsed * (1 - fraction) / fraction) << " left";
  std::cerr << std::flush;
}

}  // namespace mssim
