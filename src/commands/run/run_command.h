#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Simulated seconds of a run that says nothing of them.
inline constexpr double default_duration_s = 1;

/// Declares `mssim run`'s options; see Command::declare.
std::function<int()> declare_run(Arguments& arguments);

}  // namespace mssim
