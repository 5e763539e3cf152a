#pragma once

#include <functional>

#include "commands/arguments/arguments.h"

namespace mssim {

/// `mssim guide` (commands.cpp).
std::function<int()> declare_guide(Arguments& arguments);

}  // namespace mssim
