#pragma once

#include "backends/backend.h"

namespace mssim {

/// Where steps begin. Refers to its state.
struct StepStart {
  const State* state = nullptr;
  bool draped = false;  ///< of a garment: all its seams are closed (DressingBackend::set_draped_state)

  StepStart() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a state alone is a start.
  StepStart(const State& start, bool is_draped = false) : state(&start), draped(is_draped) {}
  StepStart(State&& start, bool is_draped = false) = delete;
};

/// Sets the backend's state. Where it is draped, the backend must be one that dresses.
void begin(Backend& backend, const StepStart& start);

}  // namespace mssim
