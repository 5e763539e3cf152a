#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "backends/interface/backend.h"
#include "backends/vectors/instruction_sets.h"

namespace mssim {

/// The vector code of a solver for one instruction set. Cloth and Bodies are what it steps: made of a system,
/// dt in s, `lanes`, the most threads and what else the solver asks for; with set_state(), state() and
/// `threads`, how many it takes.
template <class Cloth, class Bodies>
struct SolverKernel {
  std::size_t lanes;            ///< floats of a vector
  const char* instruction_set;  ///< Highway's name for it
  bool exact_roots;             ///< as inverse_length (backends/vectors/lanes-inl.h) says
  void (*step_cloth)(Cloth& cloth, int count);
  void (*step_bodies)(Bodies& bodies, int count);
};

/// Steps a cloth or bodies; `more` is what else the solver asks for.
template <class Cloth, class Bodies, class... More>
std::unique_ptr<Backend> make_vector_backend(const SolverKernel<Cloth, Bodies>& kernel, std::string device,
                                             const System& system, double dt_s, int threads,
                                             const More&... more) {
  const auto most_threads = static_cast<std::size_t>(threads);
  if (std::holds_alternative<GridPatch>(system.topology))
    return std::make_unique<VectorBackend<Cloth>>(std::move(device), kernel.step_cloth, system, dt_s,
                                                  kernel.lanes, most_threads, more...);
  return std::make_unique<VectorBackend<Bodies>>(std::move(device), kernel.step_bodies, system, dt_s,
                                                 kernel.lanes, most_threads, more...);
}

}  // namespace mssim
