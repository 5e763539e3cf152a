#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim measure`'s options; see Command::declare.
std::function<int()> declare_measure(CLI::App& app);

}  // namespace mssim
