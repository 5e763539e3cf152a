#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim list`'s options; see Command::declare.
std::function<int()> declare_list(Arguments& arguments);

}  // namespace mssim
