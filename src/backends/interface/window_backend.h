#pragma once

#include "backends/interface/backend.h"
#include "model/topology.h"

namespace mssim {

/// A backend for a cloth of which no single process has the whole: it builds the scene by itself, and gives
/// the states of some nodes at a time. Neither set_state nor state may be called of it.
class WindowBackend : public Backend {
 public:
  /// Goes back to the scene's start state.
  virtual void restart() = 0;
  /// The present state of the window's nodes, row by row.
  virtual State window(const GridWindow& window) const = 0;
};

}  // namespace mssim
