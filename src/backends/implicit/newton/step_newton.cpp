// The threads of a step, each running the methods of newton_method.h, and the equation's functions for a
// chunk of nodes.
#include "backends/vectors/instruction_sets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "backends/implicit/newton/step_newton.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "backends/implicit/newton/step_newton.h"
#include "backends/implicit/nodes/node_vectors-inl.h"
#include "backends/threads/spin_barrier.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// A sum of floats in double precision, lane by lane until the end.
class DoubleSum {
 public:
  HWY_INLINE DoubleSum() : low_(hn::Zero(Tag())), high_(hn::Zero(Tag())) {}
  HWY_INLINE void add(Lanes values) {
#if HWY_TARGET == HWY_SCALAR
    low_ = hn::Add(low_, hn::PromoteTo(Tag(), values.v));
#else
    const hn::Half<RealTag> half;
    low_ = hn::Add(low_, hn::PromoteTo(Tag(), hn::LowerHalf(half, values.v)));
    high_ = hn::Add(high_, hn::PromoteTo(Tag(), hn::UpperHalf(half, values.v)));
#endif
  }
  HWY_INLINE double total() const { return hn::GetLane(hn::SumOfLanes(Tag(), hn::Add(low_, high_))); }

 private:
  using Tag = hn::Rebind<double, hn::Half<RealTag>>;
  hn::Vec<Tag> low_, high_;
};

/// The block of P of a vector of nodes, from its address in VectorEquation::inverse.
HWY_INLINE SymmetricBlock<Lanes> load_block(const float* from) {
  const std::size_t n = lane_count();
  const auto load = [&](std::size_t i)
                        MSSIM_INLINE_LAMBDA { return Lanes(hn::Load(RealTag(), from + i * n)); };
  return {load(0), load(1), load(2), load(3), load(4), load(5)};
}
template <class Free>
HWY_INLINE void store_block(float* to, Free free, const SymmetricBlock<Lanes>& block) {
  for (const Lanes& number : {block.xx, block.xy, block.xz, block.yy, block.yz, block.zz}) {
    hn::Store(keep(free, number).v, RealTag(), to);
    to += lane_count();
  }
}

/// Calls act(float) with the offset of each vector of floats of a chunk in a field.
template <class Nodes, class Act>
HWY_INLINE void for_each_float(const Nodes& nodes, IndexRange chunk, Act&& act) {
  const IndexRange floats = nodes.floats_of(chunk);
  for (std::size_t i = floats.begin; i < floats.end; i += lane_count()) act(i);
}

/// Computes e, A and P. Returns e . M^-1 e over mass. at_state: at x and w = v, e of the first Newton step.
template <bool at_state, class Nodes>
HWY_NOINLINE double linearise_chunk(VectorEquation<Nodes>& equation, IndexRange chunk) {
  const Lanes dt(equation.dt), viscous_damping(equation.nodes.surroundings.viscous_damping),
      gravity(equation.nodes.surroundings.gravity);
  const Lanes inertia = mul_add(dt, viscous_damping, Lanes(1.0F));
  const float *const x = equation.x.data(), *const v = equation.v.data(),
                     *const w = at_state ? v : equation.w.data();
  float *const e = equation.e.data(), *const slopes = equation.slopes.data(),
               *const inverse = equation.inverse.data(), *const y = equation.y.data();
  DoubleSum norm;
  for_each_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    const NodeLanes node{vector.load(x), vector.load(w)};
    Lanes3 pull = zero3();
    SymmetricBlock<Lanes> block{inertia, Lanes(0.0F), Lanes(0.0F), inertia, Lanes(0.0F), inertia};
    vector.for_each_spring([&](const auto& springs) MSSIM_INLINE_LAMBDA {
      const SpringLanes& spring = springs.law;
      const Lanes3 u = springs.load(w) - node.v;
      Lanes3 d = springs.load(x) - node.x;
      // Not the difference of x + dt w, whose rounding would lose most digits of a small stretch.
      if constexpr (!at_state) d = mul_add(dt, u, d);
      const Lanes inverse_root = inverse_length(dot(d, d));
      SlopeLanes slope{inverse_root * d, spring_across_definite(inverse_root, spring)};
      Lanes3 force = spring_pull_at(inverse_root, dot(u, d), spring) * d;
      if constexpr (at_state)
        force = mul_add(dt, spring_jacobian_times(slope.n, spring_along(spring), slope.across, u), force);
      pull = pull + keep(springs.exists, force);
      slope.across = dt * (dt * slope.across);
      slope = keep(springs.exists, slope);
      if (slopes != nullptr) springs.store_slope(slopes, slope);
      const Lanes along = keep(springs.exists, spring_step_along(dt, spring.constants));
      block = block_sum(block, spring_jacobian(slope.n.x, slope.n.y, slope.n.z, along, slope.across));
    });
    Lanes3 missing = dt * node_acceleration(pull, node.v, viscous_damping, gravity);
    if constexpr (!at_state) missing = missing - (node.v - vector.load(v));
    missing = keep(vector.free, missing);
    vector.store(e, missing);
    if (y != nullptr) vector.store(y, at_state ? node.x : mul_add(dt, node.v, node.x));
    norm.add(vector.weighted(dot(missing, missing)));
    store_block(inverse + vector.number * 6 * lane_count(), vector.free, block_inverse(block));
  });
  return norm.total();
}

/// s = 0, p = 0, z = P e. Returns e . z.
template <class Nodes>
HWY_NOINLINE double start_chunk(VectorEquation<Nodes>& equation, IndexRange chunk) {
  float *const s = equation.s.data(), *const p = equation.p.data(), *const z = equation.z.data();
  const float *const e = equation.e.data(), *const inverse = equation.inverse.data();
  DoubleSum sum;
  for_each_float(equation.nodes, chunk, [&](std::size_t i) MSSIM_INLINE_LAMBDA {
    hn::Store(hn::Zero(RealTag()), RealTag(), s + i);
    hn::Store(hn::Zero(RealTag()), RealTag(), p + i);
  });
  for_each_whole_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    const Lanes3 here = vector.load(e),
                 solved = block_times(load_block(inverse + vector.number * 6 * lane_count()), here);
    vector.store(z, solved);
    sum.add(vector.weighted(dot(here, solved)));
  });
  return sum.total();
}

/// result = factor a + b, for fields of which `result` may be one.
template <class Nodes>
HWY_NOINLINE void combine_chunk(const Nodes& nodes, IndexRange chunk, float* result, float factor,
                                const float* a, const float* b) {
  const RealTag d;
  const auto f = hn::Set(d, factor);
  for_each_float(nodes, chunk, [&](std::size_t i) MSSIM_INLINE_LAMBDA {
    hn::Store(hn::MulAdd(f, hn::Load(d, a + i), hn::Load(d, b + i)), d, result + i);
  });
}

/// q = A p. Returns p . q. Its results for fixed and missing nodes are unused.
template <class Nodes>
HWY_NOINLINE double multiply_chunk(VectorEquation<Nodes>& equation, IndexRange chunk) {
  const Lanes dt(equation.dt);
  const Lanes inertia = mul_add(dt, Lanes(equation.nodes.surroundings.viscous_damping), Lanes(1.0F));
  float* const q = equation.q.data();
  const float *const p = equation.p.data(), *const slopes = equation.slopes.data();
  DoubleSum sum;
  for_each_whole_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    const Lanes3 here = vector.load(p);
    Lanes3 product = inertia * here;
    vector.for_each_spring([&](const auto& springs) MSSIM_INLINE_LAMBDA {
      const SlopeLanes slope = springs.load_slope(slopes);
      product = product - spring_jacobian_times(slope.n, spring_step_along(dt, springs.law.constants),
                                                slope.across, springs.load(p) - here);
    });
    vector.store(q, product);
    sum.add(vector.weighted(dot(here, product)));
  });
  return sum.total();
}

/// The product without stored slopes: they are recomputed from the positions of the linearisation.
template <class Nodes>
HWY_NOINLINE double multiply_chunk_anew(VectorEquation<Nodes>& equation, IndexRange chunk) {
  const Lanes dt(equation.dt);
  const Lanes inertia = mul_add(dt, Lanes(equation.nodes.surroundings.viscous_damping), Lanes(1.0F));
  float* const q = equation.q.data();
  const float *const p = equation.p.data(), *const y = equation.y.data();
  DoubleSum sum;
  for_each_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    const Lanes3 here = vector.load(p), place = vector.load(y);
    Lanes3 product = inertia * here;
    vector.for_each_spring([&](const auto& springs) MSSIM_INLINE_LAMBDA {
      const SpringLanes& spring = springs.law;
      const Lanes3 d = springs.load(y) - place;
      const Lanes inverse_root = inverse_length(dot(d, d));
      const Lanes across = dt * (dt * spring_across_definite(inverse_root, spring));
      product = product - keep(springs.exists, spring_jacobian_times(inverse_root * d,
                                                                     spring_step_along(dt, spring.constants),
                                                                     across, springs.load(p) - here));
    });
    product = keep(vector.free, product);
    vector.store(q, product);
    sum.add(vector.weighted(dot(here, product)));
  });
  return sum.total();
}

/// s += factor p, e -= factor q, z = P e. Returns e . z.
template <class Nodes>
HWY_NOINLINE double advance_chunk(VectorEquation<Nodes>& equation, IndexRange chunk, float factor) {
  float *const s = equation.s.data(), *const e = equation.e.data(), *const z = equation.z.data();
  const float *const p = equation.p.data(), *const q = equation.q.data(),
                     *const inverse = equation.inverse.data();
  const Lanes forward(factor), back(-factor);
  DoubleSum sum;
  for_each_whole_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    vector.store(s, mul_add(forward, vector.load(p), vector.load(s)));
    const Lanes3 left = mul_add(back, vector.load(q), vector.load(e)),
                 solved = block_times(load_block(inverse + vector.number * 6 * lane_count()), left);
    vector.store(e, left);
    vector.store(z, solved);
    sum.add(vector.weighted(dot(left, solved)));
  });
  return sum.total();
}

/// a . M b over mass, for fields a and b that are zero at fixed nodes.
template <class Nodes>
HWY_NOINLINE double product_chunk(const VectorEquation<Nodes>& equation, IndexRange chunk, const float* a,
                                  const float* b) {
  DoubleSum sum;
  for_each_whole_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    sum.add(vector.weighted(dot(vector.load(a), vector.load(b))));
  });
  return sum.total();
}

/// (w - v) . M (w - v) over mass.
template <class Nodes>
HWY_NOINLINE double change_chunk(const VectorEquation<Nodes>& equation, IndexRange chunk) {
  const float *const w = equation.w.data(), *const v = equation.v.data();
  DoubleSum sum;
  for_each_whole_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    const Lanes3 change = vector.load(w) - vector.load(v);
    sum.add(vector.weighted(dot(change, change)));
  });
  return sum.total();
}

/// v = w, x += dt w, and the floor acts.
template <class Nodes>
HWY_NOINLINE void end_chunk(VectorEquation<Nodes>& equation, IndexRange chunk) {
  const Surroundings surroundings = equation.nodes.surroundings;
  const Lanes dt(equation.dt);
  float *const x = equation.x.data(), *const v = equation.v.data();
  const float* const w = equation.w.data();
  for_each_vector(equation.nodes, chunk, [&](const auto& vector) MSSIM_INLINE_LAMBDA {
    Lanes3 velocity = vector.load(w), position = mul_add(dt, velocity, vector.load(x));
    touch_floor(vector.free, surroundings, position, velocity);
    vector.store(x, position);
    vector.store(v, velocity);
  });
}

/// A VectorEquation for one of its threads; newton_method.h describes the functions. All threads call the
/// same functions and get the same numbers: sums over chunks, in their order.
template <class Nodes>
class TeamEquation {
 public:
  TeamEquation(VectorEquation<Nodes>& shared, const Team& team)
      : shared_(shared),
        barrier_(team.barrier),
        begin_(team.begin(shared.nodes.chunks.size())),
        end_(team.end(shared.nodes.chunks.size())) {}

  void begin() {
    for_own_chunks([&](IndexRange chunk) HWY_ATTR {
      const IndexRange floats = shared_.nodes.floats_of(chunk);
      std::copy(shared_.v.data() + floats.begin, shared_.v.data() + floats.end,
                shared_.w.data() + floats.begin);
    });
  }
  void linearise_at_state() {
    barrier_.wait();  // others have written x and v
    sum_over_chunks([&](IndexRange chunk) HWY_ATTR { return linearise_chunk<true>(shared_, chunk); });
  }
  double linearise() {
    barrier_.wait();  // others have written x and w
    return sum_over_chunks([&](IndexRange chunk) HWY_ATTR { return linearise_chunk<false>(shared_, chunk); });
  }
  double start_solving() {
    return sum_over_chunks([&](IndexRange chunk) HWY_ATTR { return start_chunk(shared_, chunk); });
  }
  double turn(double factor) {
    combine(shared_.p, factor, shared_.p, shared_.z);
    barrier_.wait();
    return sum_over_chunks([&](IndexRange chunk) HWY_ATTR {
      return shared_.keeps_slopes() ? multiply_chunk(shared_, chunk) : multiply_chunk_anew(shared_, chunk);
    });
  }
  double advance(double factor) {
    return sum_over_chunks(
        [&](IndexRange chunk) HWY_ATTR { return advance_chunk(shared_, chunk, static_cast<float>(factor)); });
  }
  void add(double factor) { combine(shared_.w, factor, shared_.s, shared_.w); }
  double along_solution() { return product(shared_.e.data(), shared_.s.data()); }
  double motion() { return product(shared_.w.data(), shared_.w.data()); }
  double change() {
    return sum_over_chunks([&](IndexRange chunk) HWY_ATTR { return change_chunk(shared_, chunk); });
  }
  void end() {
    for_own_chunks([&](IndexRange chunk) HWY_ATTR { end_chunk(shared_, chunk); });
  }

 private:
  template <class Act>
  void for_own_chunks(Act&& act) {
    for (std::size_t chunk = begin_; chunk < end_; ++chunk) act(shared_.nodes.chunks[chunk]);
  }

  void combine(AlignedArray& result, double factor, const AlignedArray& a, const AlignedArray& b) {
    for_own_chunks([&](IndexRange chunk) HWY_ATTR {
      combine_chunk(shared_.nodes, chunk, result.data(), static_cast<float>(factor), a.data(), b.data());
    });
  }

  double product(const float* a, const float* b) {
    return sum_over_chunks([&](IndexRange chunk) HWY_ATTR { return product_chunk(shared_, chunk, a, b); });
  }

  /// The sum of act(chunk) over all chunks of all threads, when all have called it.
  template <class Act>
  double sum_over_chunks(Act&& act) {
    // A thread still adding this sum may overlap with one that writes the next sum's parts, but not the one
    // after.
    std::vector<double>& sums = shared_.sums[sums_++ % 2];
    for (std::size_t chunk = begin_; chunk < end_; ++chunk) sums[chunk] = act(shared_.nodes.chunks[chunk]);
    barrier_.wait();
    double total = 0;
    for (const double sum : sums) total += sum;
    return shared_.nodes.sum_factor() * total;
  }

  VectorEquation<Nodes>& shared_;
  SpinBarrier& barrier_;
  const std::size_t begin_, end_;  ///< of its chunks
  std::size_t sums_ = 0;
};

template <class Nodes>
void take_steps(VectorEquation<Nodes>& shared, int count) {
  with_team(shared.threads, [&](const Team& team) HWY_ATTR {
    TeamEquation<Nodes> equation(shared, team);
    SolverWork work;  // identical in all threads
    for (int step = 0; step < count; ++step) take_step(equation, *shared.integrator, shared.goal, work);
    if (team.thread == 0) shared.work += work;
  });
}

StepKernel<VectorEquation<NodeRows>> newton_cloth_kernel() { return kernel_here(&take_steps<NodeRows>); }
StepKernel<VectorEquation<NodeSlices>> newton_bodies_kernel() { return kernel_here(&take_steps<NodeSlices>); }

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mssim {
MSSIM_COMPILED_KERNELS(VectorEquation<NodeRows>, newton_cloth_kernel)
MSSIM_COMPILED_KERNELS(VectorEquation<NodeSlices>, newton_bodies_kernel)
}  // namespace mssim
#endif
