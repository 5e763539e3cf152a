#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "garment/stepping/dressing_backend.h"

namespace mssim {

/// A row of the TABLE of Algorithm 1 of Vassilev, "Accelerating computations on an Android mobile device", as
/// printed: six loops over springs, points and joints, each with or without `parallel for`.
///
/// The paper specifies ("Cloth simulation", "Background", "SIMD instruction for accelerating computations"):
/// - The loops and their order: (1) the force of each spring, Eq. (2), is added to both ends; (2) viscous
///   damping and gravity are added; (3) each joint pulls its ends; (4) velocities are updated, Eq. (1), and
///   those of points that would enter the body change; (5) over-elongated springs of all three kinds change
///   the velocities of their ends, once; (6) positions are updated. A step does nothing else. Loops 4 and 5
///   change no position.
/// - Threads: OpenMP's `parallel for` over the springs, points or joints of a loop, with a barrier after
///   each.
/// - SIMD: additions, products and dot products of vectors of three components.
///
/// The paper leaves these choices open:
/// - The data race. Threads add to shared nodes in loops 1, 3 and 5, and the paper has neither lock nor
///   atomic. Here, threads process batches of springs in rounds; the batches of a round have no common node.
///   Rows without threads use the same order, so that all are bitwise identical.
/// - SIMD: a register holds one point. Without SIMD, the compiler gets plain floats, with the same options.
/// - The correction: each of two ends of equal mass loses half of the velocity that lengthens a spring, as
///   with `"correction": "published"` elsewhere. The threshold is the scene's; with `"correction": "none"`,
///   there is no loop 5. The paper refers to "Fast cloth animation on walking avatars" (2001), its [5].
/// - The body: planes of a pixel instead of its depth (BodyMaps). Velocity into the body is removed, and
///   friction is Coulomb's. The paper refers to [5] here, too.
/// - Joints: the force on an open joint is the scene's; the paper gives none. The paper does not say what
///   holds a closed seam. Here, a joint that has come near is a spring of natural length zero, as stiff as
///   the cloth, in loop 3.
/// - Phases: damping, gravity and friction are the scene's, while seams close and afterwards. Upper edges are
///   not held, there is no floor, and panels pass through each other: Figure 6 has no cloth-cloth collisions.
struct PublishedDressing {
  std::string_view name;
  std::string_view description;  ///< one line for `mssim list backends`
  bool simd = false;             ///< with the paper's SIMD instructions
  bool parallel = false;         ///< the paper's "with parallelization"
};

/// The TABLE, in the order of all listings. It is in this header because readers of results do not link the
/// loops.
inline constexpr auto published_dressings = std::to_array<PublishedDressing>({
    {"algorithm1", "garments, as published: the six loops of Vassilev's Algorithm 1, one after the other"},
    {"algorithm1-simd", "algorithm1 with SIMD instructions for vectors of three components", true},
    {"algorithm1-threads", "algorithm1, each loop a `parallel for`", false, true},
    {"algorithm1-threads-simd", "algorithm1-threads with SIMD instructions", true, true},
});

/// Makes the loops of a row. Throws Unsupported for an integrator other than semi-euler. The loops ignore
/// Garment::touching; make_dressing_backend refuses such a garment.
using MakePublishedDressing = std::unique_ptr<DressingBackend> (*)(const System& system,
                                                                   const Integrator& integrator, double dt_s,
                                                                   const ExecutionOptions& options);
MakePublishedDressing maker_of(const PublishedDressing& dressing);

/// Makes the loops in double precision, with which the rows are compared.
std::unique_ptr<DressingBackend> make_published_reference(const System& system, const Integrator& integrator,
                                                          double dt_s);

}  // namespace mssim
