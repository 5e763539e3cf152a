#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim compare`'s options; see Command::declare.
std::function<int()> declare_compare(Arguments& arguments);

}  // namespace mssim
