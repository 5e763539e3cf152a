#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim run`'s options; see Command::declare.
std::function<int()> declare_run(Arguments& arguments);

}  // namespace mssim
