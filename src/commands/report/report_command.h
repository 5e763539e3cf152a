#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim report`'s options; see Command::declare.
std::function<int()> declare_report(Arguments& arguments);

}  // namespace mssim
