#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim render`'s options; see Command::declare.
std::function<int()> declare_render(Arguments& arguments);

}  // namespace mssim
