#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "garment/stepping/dressing_backend.h"

namespace mssim {

/// A row of the TABLE of Algorithm 1 of Vassilev, "Accelerating computations on an Android mobile device", as
/// printed: six loops over springs, points and joints, each a `parallel for` or none.
///
/// The paper's ("Cloth simulation", "Background", "SIMD instruction for accelerating computations"):
/// - the loops, their order, and what each computes: (1) the force of each spring, Eq. (2), is added to both
///   ends; (2) viscous damping and gravity are added; (3) each joint pulls its ends; (4) velocities are
///   updated, Eq. (1), and those of points that would enter the body change; (5) over-elongated springs of
///   all three kinds change the velocities of their ends, once; (6) positions are updated. Nothing else
///   happens in a step. Loops 4 and 5 change no position;
/// - threads: OpenMP's `parallel for` over the springs, points or joints of a loop, and a barrier after each;
/// - SIMD: additions, products and dot products of vectors of three components.
///
/// Chosen here, because the paper does not say:
/// - The data race. Threads add to nodes that they share in loops 1, 3 and 5, and the paper has neither lock
///   nor atomic. Here the springs are taken in batches, and batches without a common node side by side, in as
///   many rounds as that takes. The rows without threads take the same order, so that all have the same bits.
/// - SIMD: a register holds one point. Without it the compiler gets plain floats, with the same options.
/// - The correction: half of what lengthens a spring further is taken from each end of equal mass, as
///   `"correction": "published"` does elsewhere. The threshold is the scene's. The paper refers to "Fast
///   cloth animation on walking avatars" (2001), its [5].
/// - The body: planes of a pixel instead of its depth (BodyMaps). Velocity into the body is dropped, and
///   friction is Coulomb's. The paper refers to [5] here, too.
/// - Joints: the force is the scene's; the paper gives none. That force pulls each open joint. The paper does
///   not say what holds a closed seam. Here a joint that has come near is a spring of natural length zero, as
///   stiff as the cloth, in loop 3.
/// - Phases: damping, gravity and friction are the scene's, while seams close and after. Upper edges are not
///   held, there is no floor, and panels pass through each other: Figure 6 has no cloth-cloth collisions.
struct PublishedDressing {
  std::string_view name;
  std::string_view description;  ///< one line for `mssim list backends`
  bool simd = false;             ///< with the paper's SIMD instructions
  bool parallel = false;         ///< the paper's "with parallelization"
};

/// The TABLE, in the order of every listing. In this header, because readers of results are linked without
/// the loops.
inline constexpr auto published_dressings = std::to_array<PublishedDressing>({
    {"algorithm1", "garments, as published: the six loops of Vassilev's Algorithm 1, one after the other"},
    {"algorithm1-simd", "algorithm1 with SIMD instructions for vectors of three components", true},
    {"algorithm1-threads", "algorithm1, each loop a `parallel for`", false, true},
    {"algorithm1-threads-simd", "algorithm1-threads with SIMD instructions", true, true},
});

/// Makes the loops of a row. Throws Unsupported for another integrator than semi-euler, and for layers that
/// touch each other.
using MakePublishedDressing = std::unique_ptr<DressingBackend> (*)(const System& system,
                                                                   const Integrator& integrator, double dt_s,
                                                                   const ExecutionOptions& options);
MakePublishedDressing maker_of(const PublishedDressing& dressing);

/// The same loops in double precision: what the rows are verified against.
std::unique_ptr<DressingBackend> make_published_reference(const System& system, const Integrator& integrator,
                                                          double dt_s);

}  // namespace mssim
