// The walk over vectors of nodes and the forces on them, for each instruction set, held against plain loops
// in double precision.
#include "backends/vectors/instruction_sets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/backends/implicit/nodes/node_vectors_test.cpp"
#include <gtest/gtest.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "backends/implicit/nodes/node_vectors-inl.h"
#include "tests/support/systems.h"
#include "tests/support/textbook_force.h"

#ifndef MSSIM_ACCELERATION_KERNEL  // once, before the code of the first instruction set
#define MSSIM_ACCELERATION_KERNEL
namespace mssim {

/// acceleration_at() at all nodes, for one instruction set. The fields are Nodes::field_floats() long.
struct AccelerationKernel {
  std::size_t lanes;
  const char* instruction_set;
  void (*of_rows)(const NodeRows& nodes, const float* x, const float* v, float* acceleration);
  void (*of_slices)(const NodeSlices& nodes, const float* x, const float* v, float* acceleration);
};

}  // namespace mssim
#endif

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

template <class Nodes>
void store_accelerations(const Nodes& nodes, const float* x, const float* v, float* acceleration) {
  for (const NodeChunk& chunk : nodes.chunks)
    for_each_vector(nodes, chunk, [&](const auto& vector) HWY_ATTR {
      vector.store_free(acceleration, acceleration_at(vector, x, v, nodes.surroundings));
    });
}

AccelerationKernel acceleration_kernel() {
  return {lane_count(), hwy::TargetName(HWY_TARGET), &store_accelerations<NodeRows>,
          &store_accelerations<NodeSlices>};
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
HWY_EXPORT(acceleration_kernel);
std::vector<AccelerationKernel> acceleration_kernels() {
  return kernels_of_this_processor(HWY_DISPATCH_TABLE(acceleration_kernel));
}

namespace {

struct PlainAccelerations {
  std::vector<Vec3d> a;
  std::vector<double> rounding;  ///< bound of what single precision may lose
};

/// By the definition of System, in double precision; zero at pins.
PlainAccelerations plain_accelerations(const System& system) {
  const std::vector<Vec3d>&x = system.start.position, &v = system.start.velocity;
  std::vector<Vec3d> a(system.nodes());
  std::vector<double> rounding(system.nodes(), 0);
  for (const Spring& spring : system.springs) {
    const Vec3d d = x[spring.second] - x[spring.first], u = v[spring.second] - v[spring.first];
    const SpringMaterial& material = system.materials[spring.kind];
    const Vec3d force = textbook_force(material, static_cast<double>(spring.rest_length), d, u);
    // The force is the difference of two of about stiffness times length, each after three roundings.
    for (const std::uint32_t end : {spring.first, spring.second})
      rounding[end] += 6 * 0x1p-24 * material.stiffness * length(d) / system.node_mass[end];
    a[spring.first] += 1 / system.node_mass[spring.first] * force;
    a[spring.second] += -1 / system.node_mass[spring.second] * force;
  }
  for (std::size_t node = 0; node < system.nodes(); ++node)
    a[node] += Vec3d{0, -system.gravity, 0} - system.viscous_damping * v[node];
  for (const std::uint32_t pin : system.pins) a[pin] = {};
  return {a, rounding};
}

template <class Nodes, class Kernel>
void expect_plain_accelerations(const System& system, const Nodes& nodes, Kernel kernel) {
  AlignedArray x(nodes.field_floats()), v(nodes.field_floats()), acceleration(nodes.field_floats());
  write_field(nodes, system.start.position, x.data());
  write_field(nodes, system.start.velocity, v.data());
  EXPECT_EQ(read_field(nodes, x.data()), system.start.position);
  kernel(nodes, x.data(), v.data(), acceleration.data());

  const auto [expected, rounding] = plain_accelerations(system);
  const std::vector<Vec3d> found = read_field(nodes, acceleration.data());
  for (std::size_t node = 0; node < system.nodes(); ++node) {
    const Vec3d error = found[node] - expected[node];
    EXPECT_LE(std::sqrt(dot(error, error)), rounding[node] + 1e-5) << node;
  }
  // What is no node stays zero.
  write_field(nodes, std::vector<Vec3d>(system.nodes()), acceleration.data());
  EXPECT_EQ(std::count(acceleration.data(), acceleration.data() + acceleration.size(), 0.0F),
            static_cast<std::ptrdiff_t>(acceleration.size()));
}

TEST(ForceLanes, AreTheForcesOnClothsOfAnyShape) {
  for (const AccelerationKernel& kernel : acceleration_kernels())
    for (const auto& [rows, columns] : {std::pair{50U, 50U},
                                        {37U, 23U},
                                        {9U, 11U},
                                        {3U, 40U},
                                        {40U, 3U},
                                        {2U, 2U},
                                        {1U, 7U},
                                        {7U, 1U},
                                        {300U, 70U}}) {
      SCOPED_TRACE(testing::Message() << kernel.instruction_set << ", " << rows << " x " << columns);
      System system = cloth_system(rows, columns);
      if (rows > 30) system.pins.push_back(20 * columns + columns / 2);
      for (std::size_t node = 0; node < system.nodes(); ++node)
        system.start.velocity[node] = {0.25, 0.5 * std::sin(0.3 * static_cast<double>(node)), -0.125};
      for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
      round_to_single(system.start);
      expect_plain_accelerations(system, NodeRows(system, kernel.lanes), kernel.of_rows);
    }
}

TEST(ForceLanes, AreTheForcesOnBodiesOfAnyShape) {
  for (const AccelerationKernel& kernel : acceleration_kernels())
    for (System system :
         {solid_block(2, 2, 2), solid_block(3, 3, 7), solid_block(9, 9, 9), two_solid_blocks()}) {
      SCOPED_TRACE(testing::Message() << kernel.instruction_set << ", " << system.nodes() << " nodes");
      system.pins = {0, 7};
      for (const std::uint32_t pin : system.pins) system.start.velocity[pin] = {};
      expect_plain_accelerations(system, NodeSlices(system, kernel.lanes), kernel.of_slices);
    }
}

TEST(NodeChunks, HoldEverythingOnceInOrder) {
  for (const std::size_t count : {0UL, 1UL, 7UL, 256UL, 257UL, 1000UL}) {
    const auto chunks = balanced_node_chunks(count, [](std::size_t i) { return i * i; });
    EXPECT_LE(chunks.size(), most_node_chunks);
    std::size_t end = 0;
    for (const NodeChunk& chunk : chunks) {
      EXPECT_EQ(chunk.begin, end);
      EXPECT_GT(chunk.end, chunk.begin);
      end = chunk.end;
    }
    EXPECT_EQ(end, count);
  }
}

}  // namespace
}  // namespace mssim
#endif
