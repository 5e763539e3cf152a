#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// Declares `mssim new-backend`'s options; see Command::declare.
std::function<int()> declare_new_backend(Arguments& arguments);

}  // namespace mssim
