#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim list`'s options; see Command::declare.
std::function<int()> declare_list(CLI::App& app);

}  // namespace mssim
