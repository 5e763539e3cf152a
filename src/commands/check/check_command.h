#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim check`'s options; see Command::declare.
std::function<int()> declare_check(Arguments& arguments);

}  // namespace mssim
