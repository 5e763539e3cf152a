#include "commands/bench/time_budget.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "text/error.h"

namespace mssim {
namespace {

double seconds_of(TimeBudget::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

TimeBudget::Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<TimeBudget::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

TimeBudget::TimeBudget(std::optional<double> seconds, std::vector<ExpectedTime> scenes)
    : scenes_(std::move(scenes)), present_start_(Clock::now()) {
  if (!seconds) return;
  const ExpectedTime all = total(scenes_);
  const double least = all.with(1);
  if (*seconds < least)
    throw UsageError("--time-budget is too short: one round of all this takes about " +
                     std::to_string(std::lround(std::ceil(least))) +
                     " s; give more, or name fewer scenes, backends or integrators");
  end_ = present_start_ + duration_of(*seconds);
}

std::optional<TimeBudget::Clock::time_point> TimeBudget::begin_scene() {
  if (!end_) return std::nullopt;
  present_start_ = Clock::now();
  const double scale = expected_ > 0 ? taken_ / expected_ : 1;
  const double rounds = rounds_within(seconds_of(*end_ - present_start_) / scale, total(scenes_));
  present_ = scenes_.front();
  scenes_.erase(scenes_.begin());
  return present_start_ + duration_of(scale * (present_.preparation + rounds * present_.round));
}

void TimeBudget::first_round_done() {
  expected_ += present_.preparation + present_.round;
  taken_ += seconds_of(Clock::now() - present_start_);
}

}  // namespace mssim
