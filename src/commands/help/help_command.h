#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim help`'s options; see Command::declare.
std::function<int()> declare_help(CLI::App& app);

}  // namespace mssim
