#pragma once

#include <string>

namespace mssim {

/// OpenCL C generated from the stencil of a grid (model/spring.h), for programs of kernels/grid_stage.cl:
/// what all springs do to the nodes of a site.

/// `gather_springs`, for one lane: visits both ends of every spring of the stencil, each for itself.
std::string gather_springs_text();

/// `walk_springs`, for several lanes: computes the springs that a walk meets at a site, each once. What they
/// do to nodes further right goes into `Carry`, still in the lanes of the springs' left ends; what they do to
/// nodes further down goes into `sums`.
std::string walk_springs_text();

}  // namespace mssim
