#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim help`'s options; see Command::declare.
std::function<int()> declare_help(Arguments& arguments);

}  // namespace mssim
