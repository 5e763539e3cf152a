#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim bench`'s options; see Command::declare.
std::function<int()> declare_bench(Arguments& arguments);

}  // namespace mssim
