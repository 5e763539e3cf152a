#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "backends/hybrid/mapped_nodes.h"
#include "integrators/integrators.h"
#include "model/system.h"

namespace mssim {

/// Every stage of an integrator on the host's part of hybrid: in two parts by `kernel` as by `best` at once.
/// `StageOfNodes`, made of a system and an integrator, has `nodes`, `pairs` and `mapped`.
template <class StageOfNodes, class Kernel>
void expect_parts_like_the_whole(const Kernel& kernel, const Kernel& best, const System& system,
                                 const Integrator& integrator) {
  const StageOfNodes expected(system, integrator), found(system, integrator);
  const std::size_t slices = expected.nodes.slices();
  for (std::size_t stage = 0; stage < integrator.stage_count; ++stage) {
    best.integrate(expected.nodes, expected.mapped, stage, 0, slices);
    kernel.integrate(found.nodes, found.mapped, stage, slices / 3, slices);
    kernel.integrate(found.nodes, found.mapped, stage, 0, slices / 3);
  }
  for (std::size_t pair = 0; pair < pair_kinds; ++pair)
    for (std::size_t i = 0; i < expected.pairs[pair].size(); ++i)
      ASSERT_NEAR(found.mapped.pairs[pair][i], expected.mapped.pairs[pair][i],
                  1e-5 * (1 + std::abs(expected.mapped.pairs[pair][i])))
          << integrator.name << ", pair " << pair;
}

}  // namespace mssim
