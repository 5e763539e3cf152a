#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim export`'s options; see Command::declare.
std::function<int()> declare_export(Arguments& arguments);

}  // namespace mssim
