#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim check`'s options; see Command::declare.
std::function<int()> declare_check(CLI::App& app);

}  // namespace mssim
