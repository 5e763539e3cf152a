#include "commands/progress_line.h"

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

ProgressLine::ProgressLine(std::size_t scenes)
    : scenes_(scenes), terminal_(isatty(STDERR_FILENO) != 0), start_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
  if (terminal_) std::cerr << clear_line << std::flush;
}

void ProgressLine::begin_scene(const std::string& name) {
  scene_ = name;
  ++begun_;
  if (!terminal_) std::cerr << "mssim: " << name << " (" << begun_ << " of " << scenes_ << ")\n";
}

void ProgressLine::update(const std::string& activity, double done) {
  if (!terminal_) return;
  // Scenes take about the same time, whatever their size: samples are so long.
  const double share = (static_cast<double>(begun_ - 1) + done) / static_cast<double>(scenes_);
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::cerr << clear_line << scene_ << ": " << activity;
  if (share > 0.02) std::cerr << ", about " << clock_text(elapsed * (1 - share) / share) << " left";
  std::cerr << std::flush;
}

}  // namespace mssim
