#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim run`'s options; see Command::declare.
std::function<int()> declare_run(CLI::App& app);

}  // namespace mssim
