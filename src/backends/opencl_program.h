#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <string>
#include <vector>

#include "backends/opencl_device.h"
#include "integrators/integrator.h"

namespace mssim {

/// Text of the program that steps a grid with `integrator`: the shared laws, what the stages have in common
/// (kernels/*), and one kernel per stage, generated from the tables of integrators and of the stencil. It
/// depends on the integrator and on `lanes` alone (nodes side by side in one number: 1, 4, 8 or 16), so that
/// a driver's cache of built programs serves every scene. Throws std::runtime_error when a kernel file is
/// missing.
std::string grid_program_text(const Integrator& integrator, int lanes);

/// Does a work-item of the program walk over a block of rows, with one row of work-items and `sums` as the
/// last argument, or own one node? kernels/grid_stage.cl says how.
bool grid_program_walks(int lanes);

/// Text of the program that computes one force per packed spring (kernels/packed_springs.cl), `lanes` of them
/// side by side.
std::string packed_springs_program_text(int lanes);

/// Name of the stage's kernel in grid_program_text.
std::string stage_kernel_name(std::size_t stage);

/// The pairs whose buffers are the first arguments of the stage's kernel, in their order; the buffers of the
/// parameters, the pin rows and the pins follow.
std::vector<Pair> stage_arguments(const Stage& stage);

/// The built program. Square roots and divisions are correctly rounded where the device can do that.
/// Throws Unavailable with the compiler's first complaint.
cl::Program build_program(const cl::Context& context, const cl::Device& device, const std::string& text);

}  // namespace mssim
