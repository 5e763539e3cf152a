#include "application/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <string_view>
#include <utility>

#include "backends/devices/drivers.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

double seconds_between(ProgressLine::Clock::time_point from, ProgressLine::Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// "about 1:05 left", or empty.
std::string time_left(const Progress& progress) {
  if (!progress.seconds_left) return {};
  const long seconds = std::lround(*progress.seconds_left);
  return fmt::format("  about {}:{:02} left", seconds / 60, seconds % 60);
}

constexpr std::string_view notice =
    "\nmssim: stopping after the current measurement or frame; a second signal stops at once\n";

void remember(int signal) {
  note_ending_signal(signal);
  release_ending_signals(remember);  // a second one ends the process, of whichever kind it is
  static_cast<void>(!::write(STDERR_FILENO, notice.data(), notice.size()));
}

}  // namespace

std::string progress_text(const Progress& progress, int width, bool utf8) {
  constexpr std::size_t shortest_bar = 10, longest_bar = 24, around = 54;  // time left, and most activities
  std::string text = progress.scene;
  if (progress.scenes > 1) text += fmt::format(" ({} of {})", progress.number, progress.scenes);
  text += "  ";
  // A terminal may wrap after a character in its last column.
  const auto columns = static_cast<std::size_t>(std::max(1, width - 1));
  if (const std::size_t taken = width_of(text) + around; taken + shortest_bar <= columns) {
    const std::size_t length = std::min(longest_bar, columns - taken);
    const std::string filled = bar(progress.fraction, length, utf8);
    text += '[' + filled + std::string(length - width_of(filled), ' ') + ']';
  } else {
    const std::string percent = fmt::format("{} %", static_cast<int>(100 * progress.fraction));
    text.append(4 - std::min<std::size_t>(4, percent.size()), ' ').append(percent);
  }
  return std::string(clipped(text + time_left(progress) + "  " + progress.activity, columns));
}

ProgressLine::ProgressLine(std::vector<double> weights, Log log, std::optional<Clock::time_point> end)
    : weights_(std::move(weights)),
      rewrites_(terminal_of(STDERR_FILENO).rewrites),
      logs_scenes_(!rewrites_ && log == Log::scenes),
      start_(Clock::now()),
      end_(end) {}

ProgressLine::~ProgressLine() { wipe(); }

void ProgressLine::wipe() const {
  if (rewrites_) std::cerr << "\r\033[K" << std::flush;
}

void ProgressLine::begin_scene(const std::string& name) {
  wipe();
  scene_ = name;
  ++begun_;
  if (logs_scenes_) tell("{} ({} of {})", name, begun_, weights_.size());
}

void ProgressLine::skip_scene() { weights_[begun_ - 1] = 0; }

void ProgressLine::update_often(const std::string& activity, double done) {
  constexpr std::chrono::milliseconds between_lines{100};
  if (Clock::now() - shown_ >= between_lines) update(activity, done);
}

std::optional<double> ProgressLine::seconds_left(double fraction) const {
  constexpr double enough = 0.1;  // earlier, a deviation from the expectation has too much weight
  std::optional<double> seconds;
  if (fraction > enough) seconds = seconds_between(start_, shown_) * (1 - fraction) / fraction;
  if (end_) {
    const double until_end = std::max(0.0, seconds_between(shown_, *end_));
    seconds = std::min(seconds.value_or(until_end), until_end);
  }
  return seconds;
}

void ProgressLine::update(const std::string& activity, double done) {
  if (!rewrites_) return;
  shown_ = Clock::now();
  const auto present = weights_.begin() + static_cast<std::ptrdiff_t>(begun_) - 1;
  const double before = std::accumulate(weights_.begin(), present, 0.0) + done * *present;
  const double fraction = before / std::accumulate(weights_.begin(), weights_.end(), 0.0);
  Progress progress{escaped(scene_), begun_, weights_.size(), activity, std::clamp(fraction, 0.0, 1.0), {}};
  // Work at the end, such as traces, is not included in the fraction.
  if (fraction < 1) progress.seconds_left = seconds_left(fraction);
  const Terminal terminal = terminal_of(STDERR_FILENO);
  std::cerr << "\r\033[K" << progress_text(progress, terminal.width.value_or(80), terminal.utf8)
            << std::flush;
}

void tell(const std::string& sentence) { std::cerr << "mssim: " + sentence + '\n'; }

void tell_first(const std::vector<std::string>& sentences) {
  constexpr std::size_t most = 3;
  const std::size_t told = sentences.size() == most + 1 ? most + 1 : std::min(sentences.size(), most);
  for (std::size_t i = 0; i < told; ++i) tell(escaped(sentences[i]));
  if (told < sentences.size()) tell("and {} more", sentences.size() - told);
}

void tell_of_opencl() {
  static bool told = false;
  if (std::exchange(told, true)) return;
  const OpenclOffer& offer = opencl_offer();
  for (const std::string& trouble : offer.troubles) tell(trouble);
  if (!offer.note.empty()) tell(offer.note);
}

StopRequest::StopRequest() : signals_(remember, SA_RESTART) {}

StopRequest::~StopRequest() {
  signals_.restore();
  const int signal = take_ending_signal();
  if (signal == 0) return;
  remove_temporary_folder_of_process();
  std::raise(signal);
}

}  // namespace mssim
