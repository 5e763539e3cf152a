#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "garment/contact/body_maps.h"
#include "model/system.h"
// After what it needs.
#include "kernels/dressing_parameters.h"

namespace mssim {

/// A garment as the kernels of a dressing have it (kernels/dressing_parameters.h): what stays constant.
struct OpenclPanels {
  /// Throws Unsupported like GarmentGrid, where layers touch each other and where the kernels' 32-bit offsets
  /// do not reach; std::invalid_argument where the springs are not those of the panels.
  OpenclPanels(const System& system, double dt_s);

  /// Bytes of all these arrays and of those that the state takes.
  std::vector<std::uint64_t> buffer_bytes() const;

  DressingParameters parameters{};
  std::vector<std::size_t> offset;  ///< [nodes] float of a node
  std::vector<DressingBlock> blocks;
  std::vector<BodyPixel> pixels;      ///< of all layers
  std::vector<float> inverse_mass;    ///< [plane]
  std::vector<float> rest;            ///< [directions][plane]
  std::vector<float> stiffness;       ///< [directions][spring_rows]
  std::vector<cl_int> at_joint;       ///< [plane] -1 for the nodes of joints, else 0
  std::vector<DressingJoint> joints;  ///< level by level
  std::vector<cl_int> level_ends;     ///< [levels]
  std::vector<cl_int> joint_nodes;
};

/// The text of the program whose kernels step panels, for so many lanes.
std::string panels_program_text(int lanes);

/// The text of the program whose kernels step joints.
std::string joints_program_text();

}  // namespace mssim
