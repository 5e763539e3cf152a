#include "model/node_surface.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/surface.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TEST(NodeSurface, OfBodiesIsClosedAndHasNoInnerNodes) {
  const System system = two_solid_blocks();
  const NodeSurface surface = surface_of(system.topology, system.nodes());
  Surface closed{{}, surface.triangles};
  for (const std::uint32_t node : surface.node) closed.points.push_back(system.start.position[node]);
  EXPECT_NO_THROW(validate_surface(closed, "two blocks"));  // every point in use, every edge in two triangles
  EXPECT_TRUE(std::ranges::is_sorted(surface.node));
  EXPECT_EQ(surface.node.size(), system.nodes() - 2 * 3 * 1 - 1 * 1 * 5);
}

}  // namespace
}  // namespace mssim
