#pragma once

#include <span>

namespace mssim {

/// How long samples and warm-ups are.

/// A sample takes at most this many steps, so that a fast backend does not simulate far into another regime
/// (the floor) than a slow one.
inline constexpr int max_sample_steps = 2000;

/// A sample is at least so many times as long as the clock's smallest step, which is then a thousandth of it.
inline constexpr double least_clock_steps = 1000;

/// The smallest step of the steady clock that can be seen, in seconds: of a thousand readings in a row.
double clock_resolution_s();

/// Steps of a sample that is to take `sample_seconds`, when one step takes `step_seconds`: at least 1, and at
/// most `most` unless those were too short for the clock.
int sample_steps(double step_seconds, double sample_seconds, double clock_resolution_seconds,
                 int most = max_sample_steps);

/// Trials before a backend counts as warm, whatever they say.
inline constexpr int most_warm_up_trials = 20;

/// Whether trials of equal length, in seconds and in their order, show that the backend is warm: the last two
/// were not faster than the fastest before them, but for 2 %. A cold one (page faults, frequency, a driver
/// that still compiles) becomes faster from trial to trial.
bool is_warm(std::span<const double> trial_seconds);

}  // namespace mssim
