#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace mssim {

/// Declares `mssim bench`'s options; see Command::declare.
std::function<int()> declare_bench(CLI::App& app);

}  // namespace mssim
