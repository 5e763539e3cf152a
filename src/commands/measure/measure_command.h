#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim measure`'s options; see Command::declare.
std::function<int()> declare_measure(Arguments& arguments);

}  // namespace mssim
