#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim compare`'s options; see Command::declare.
std::function<int()> declare_compare(CLI::App& app);

}  // namespace mssim
