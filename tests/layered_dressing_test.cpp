// Garments of several layers in a step of Algorithm 1.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "backends/dressing/openmp_dressing.h"
#include "backends/dressing/serial_dressing.h"
#include "contact/body_maps.h"
#include "garment_system.h"
#include "integrators/integrators.h"
#include "mesh/sphere_shape.h"

namespace mssim {
namespace {

constexpr double dt_s = 1.5e-4;
const Integrator& semi_euler = *find_integrator("semi-euler");

TEST(LayeredDressing, PanelsMeetTheBodyAsTheirLayerDoes) {
  // Patches of layers 0, 1 and 2 begin half a millimetre inside a sphere's surface, before its front.
  const double radius = 0.2;
  const Surface sphere = surface_of(SphereShape{radius, 48});
  System system =
      garment_of({{4, 4, 0.01, {-0.055, 0, 0}}, {4, 4, 0.01, {-0.015, 0, 0}}, {4, 4, 0.01, {0.025, 0, 0}}});
  for (Vec3d& point : system.start.position)
    point.z = std::sqrt(std::pow(radius - 0.0005, 2) - point.x * point.x - point.y * point.y);
  // Springs of this curvature would move the nodes.
  for (SpringMaterial& material : system.materials) material.stiffness = 0;
  round_to_single(system.start);
  Garment& garment = garment_in(system);
  for (std::uint32_t layer = 0; layer < 3; ++layer) garment.panels[layer].layer = layer;
  for (const double offset : {0.002, 0.005})
    garment.body_maps.push_back(
        std::make_shared<BodyMaps>(sphere, BodyMapSettings{.pixel = 0.001, .offset = offset}));

  const std::vector<double> wanted{0.002, 0.005, 0.005};  // the third layer has no maps of its own
  for (const auto& backend :
       {make_serial_dressing(system, semi_euler, dt_s), make_openmp_dressing(system, semi_euler, dt_s, 2)}) {
    backend->step(100);  // at 1 m/s far enough for 15 mm
    const std::vector<Vec3d> position = backend->state().position;
    for (const GarmentPanel& panel : garment.panels)
      for (std::uint32_t node = panel.first_node; node < panel.first_node + panel.nodes(); ++node)
        EXPECT_NEAR(length(position[node]) - radius, wanted[panel.layer], 5e-4) << "node " << node;
  }
}

}  // namespace
}  // namespace mssim
