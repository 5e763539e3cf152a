#pragma once

#include <vector>

#include "backends/implicit/nodes/plain_nodes.h"

namespace mssim {

/// The equation of newton_method.h, which says what each function does, as a straightforward program holds
/// it: arrays of nodes, and for each spring of the list what it adds to A.
template <class Real>
class SpringEquation {
 public:
  /// `system` must outlive it.
  SpringEquation(const System& system, double dt_s);

  void set_state(const State& state) { nodes_.set_state(state); }
  State state() const { return nodes_.state(); }

  void begin();
  void linearise_at_state();
  double linearise();
  double start_solving();
  double turn(double factor);
  double advance(double factor);
  void add(double factor);
  double along_solution() const;
  double motion() const;
  double change() const;
  void end();

  /// e and s, for tests.
  const std::vector<Vec3<Real>>& residual() const { return e_; }
  const std::vector<Vec3<Real>>& solution() const { return s_; }

 private:
  struct Material {
    Real stiffness, damping;
  };
  /// A spring's part of A: along n n^T + across (I - n n^T), kg.
  struct SpringSlope {
    Vec3<Real> n;
    Real along, across;
  };

  template <bool at_state>
  double linearise_springs();
  /// z = P e. Returns e . z.
  double precondition();

  const std::vector<Spring>& springs_;
  PlainNodes<Real> nodes_;
  Real dt_;
  std::vector<Material> materials_;
  std::vector<SpringSlope> slopes_;            ///< [springs]
  std::vector<SymmetricBlock<Real>> inverse_;  ///< [nodes] P, 1/kg; zero where pinned, so that z, p and s are
  std::vector<Vec3<Real>> w_, z_, p_, s_;      ///< [nodes] m/s
  std::vector<Vec3<Real>> e_, q_;              ///< [nodes] N s
};

extern template class SpringEquation<float>;
extern template class SpringEquation<double>;

}  // namespace mssim
