// Halide (cloths only): each spring is computed once, in a window that slides down the rows of a strip. What
// the window keeps of a spring is its pull over its length, from which both of its nodes find the force.
// Threads have strips, vectors lie along a row; a cloth larger than a cache takes two steps in one pass.
#include <Halide.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mssim_backend.h"

namespace {

using Halide::Expr;
using Halide::Func;
using Halide::Var;

struct Spring {
  int rows, columns, kind;  // to the other end; 0 structural, 1 shear, 2 bending
};
/// Springs that stay in their row are needed for it alone, the others also for the two rows below.
const std::array<std::vector<Spring>, 2> springs{
    {{{0, 1, 0}, {0, 2, 2}}, {{1, 0, 0}, {1, 1, 1}, {1, -1, 1}, {2, 0, 2}}}};
constexpr int ring = 6, margin = 16;  // rows and columns around the cloth that may be read

using Floats = std::vector<float>;
using Buffer = Halide::Runtime::Buffer<float>;

/// Where the first line of cache begins.
float* aligned(Floats& floats) {
  constexpr std::uintptr_t line = 64;
  return floats.data() +
         (line - reinterpret_cast<std::uintptr_t>(floats.data()) % line) % line / sizeof(float);
}

/// With a step as the unit of time.
class Cloth : public mssim_backend::Backend {
 public:
  explicit Cloth(const mssim_backend::System& system)
      : rows_(static_cast<int>(system.grid->rows)),
        columns_(static_cast<int>(system.grid->columns)),
        padded_((columns_ + margin - 1) / margin * margin),
        pitch_(padded_ + 2 * margin),
        threads_(system.threads),
        dt_(system.dt),
        viscous_(static_cast<float>(system.viscous_damping * dt_)),
        gravity_(static_cast<float>(system.gravity[1] * dt_ * dt_)),
        floor_(system.floor),
        free_(static_cast<std::size_t>(pitch_ * (rows_ + 2 * ring) + margin)) {
    for (std::size_t s = 0; s < system.springs.size(); ++s) {
      const std::size_t kind = system.kind[s];
      stiffness_[kind] = static_cast<float>(system.stiffness[s] / system.mass[0] * dt_ * dt_);
      rest_[kind] = static_cast<float>(system.rest_length[s]);
      damping_[kind] = static_cast<float>(system.damping[s] / system.mass[0] * dt_);
    }
    float* const free = aligned(free_);
    const auto mask = [&](int row, int column) -> float& {
      return free[(row + ring) * pitch_ + margin + column];
    };
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) mask(row, column) = 1;
    for (const std::uint32_t pin : system.pins)
      mask(static_cast<int>(pin) / columns_, static_cast<int>(pin) % columns_) = 0;
    const halide_dimension_t free_shape[]{{-margin, pitch_, 1}, {-ring, rows_ + 2 * ring, pitch_}};
    free_buffer_ = Buffer(free, 2, free_shape);

    for (std::size_t s : {0, 1}) {
      states_[s].resize(6 * free_.size());
      // The nodes around the cloth are pinned far from all others, that no spring has the length zero.
      for (int row = -ring; row < rows_ + ring; ++row)
        for (int column = -margin; column < padded_ + margin; ++column) {
          at(s, row, 0, column) = 1e3F * static_cast<float>(column + 2 * margin);
          at(s, row, 1, column) = 1e3F * static_cast<float>(row + 2 * ring);
        }
      const halide_dimension_t whole[]{
          {-margin, pitch_, 1}, {0, 6, pitch_}, {-ring, rows_ + 2 * ring, 6 * pitch_}};
      const halide_dimension_t component[]{{0, padded_, 1}, {0, rows_, 6 * pitch_}};
      from_[s] = Buffer(&at(s, -ring, 0, -margin), 3, whole);
      for (int i = 0; i < 6; ++i) to_[s][static_cast<std::size_t>(i)] = Buffer(&at(s, 0, i, 0), 2, component);
    }

    Halide::Internal::JITSharedRuntime::set_num_threads(threads_);
    constexpr std::size_t cache = 4 << 20;
    pass_ = states_[0].size() * sizeof(float) > cache ? 2 : 1;
    one_step_ = compiled(1);
    one_pass_ = pass_ == 1 ? one_step_ : compiled(pass_);
    about.precision = "single";
    about.note = PEER_NOTE;  // Halide, settings and the lines of this file, from whoever compiles it
  }

  void set(const mssim_backend::Vectors& x, const mssim_backend::Vectors& v) override {
    for (std::size_t node = 0; node < x.size(); ++node)
      for (int i = 0; i < 3; ++i) {
        const int row = static_cast<int>(node) / columns_, column = static_cast<int>(node) % columns_;
        at(now_, row, i, column) = static_cast<float>(x[node][static_cast<std::size_t>(i)]);
        at(now_, row, i + 3, column) = static_cast<float>(v[node][static_cast<std::size_t>(i)] * dt_);
      }
  }

  void get(mssim_backend::Vectors& x, mssim_backend::Vectors& v) override {
    for (std::size_t node = 0; node < x.size(); ++node)
      for (int i = 0; i < 3; ++i) {
        const int row = static_cast<int>(node) / columns_, column = static_cast<int>(node) % columns_;
        x[node][static_cast<std::size_t>(i)] = at(now_, row, i, column);
        v[node][static_cast<std::size_t>(i)] = at(now_, row, i + 3, column) / dt_;
      }
  }

  void step(int count) override {
    for (; count >= pass_; count -= pass_) take(one_pass_);
    for (; count > 0; --count) take(one_step_);
  }

 private:
  float& at(std::size_t state, int row, int component, int column) {
    return aligned(states_[state])[((row + ring) * 6 + component) * pitch_ + margin + column];
  }

  void take(const Halide::Callable& pipeline) {
    std::array<Buffer, 6>& to = to_[1 - now_];
    if (pipeline(from_[now_], free_buffer_, to[0], to[1], to[2], to[3], to[4], to[5]) != 0)
      throw std::runtime_error("Halide's pipeline failed");
    now_ = 1 - now_;
  }

  /// The pulls over lengths of these springs from node (x, y) of a state(column, row, component); 0 where
  /// there is no spring.
  template <class State>
  Func pulls(const State& state, const std::vector<Spring>& from_here) const {
    std::vector<Expr> all;
    for (const Spring& spring : from_here) {
      Expr square = 0.0F, closing = 0.0F;
      for (int i = 0; i < 3; ++i) {
        const auto difference = [&](int component) {
          return state(x + spring.columns, y + spring.rows, component) - state(x, y, component);
        };
        square += difference(i) * difference(i);
        closing += difference(i + 3) * difference(i);
      }
      const Expr inverse = 1.0F / sqrt(square);
      const auto kind = static_cast<std::size_t>(spring.kind);
      const auto in_rows = [&](float constant) {
        return select(y >= 0 && y < rows_ - spring.rows, constant, 0.0F);
      };
      const Expr pull = in_rows(stiffness_[kind]) * (1.0F - rest_[kind] * inverse) +
                        in_rows(damping_[kind]) * closing * inverse * inverse;
      const Expr in_columns = x >= std::max(0, -spring.columns) && x < columns_ - std::max(0, spring.columns);
      all.push_back(spring.columns == 0 ? pull : select(likely(in_columns), pull, 0.0F));
    }
    Func f;
    f(x, y) = Halide::Tuple(all);
    return f;
  }

  /// What the springs of node (x, y) do to it, whose pulls each stand at the node where the spring begins.
  template <class State>
  Func acceleration(const State& state, const std::array<Func, 2>& pull) const {
    std::array<Expr, 3> sum{0.0F, 0.0F, 0.0F};
    for (std::size_t group = 0; group < springs.size(); ++group)
      for (std::size_t s = 0; s < springs[group].size(); ++s)
        for (const int sign : {1, -1}) {
          const int columns = sign * springs[group][s].columns, rows = sign * springs[group][s].rows;
          const Expr p =
              pull[group](x + (sign < 0 ? columns : 0), y + (sign < 0 ? rows : 0))[static_cast<int>(s)];
          for (int i = 0; i < 3; ++i)
            sum[static_cast<std::size_t>(i)] += p * (state(x + columns, y + rows, i) - state(x, y, i));
        }
    Func f;
    f(x, y) = Halide::Tuple(sum[0], sum[1], sum[2]);
    return f;
  }

  /// Semi-implicit Euler and the floor.
  template <class State>
  Func moved(const State& state, const Func& acceleration, const Halide::ImageParam& free) const {
    std::array<Expr, 3> p, v;
    for (std::size_t i : {0, 1, 2}) {
      const Expr here = state(x, y, static_cast<int>(i)), speed = state(x, y, static_cast<int>(i) + 3);
      const Expr a = acceleration(x, y)[static_cast<int>(i)] - viscous_ * speed;
      v[i] = speed + free(x, y) * (i == 1 ? a + gravity_ : a);
      p[i] = here + v[i];
    }
    const auto height = static_cast<float>(floor_.height), friction = static_cast<float>(floor_.friction);
    const Expr below = p[1] < height && free(x, y) > 0.0F;
    const Expr rebound = select(v[1] < 0.0F, -static_cast<float>(floor_.restitution) * v[1], v[1]);
    const Expr slide = sqrt(v[0] * v[0] + v[2] * v[2] + 1e-30F);
    const Expr grip = max(0.0F, 1.0F - friction * (rebound - v[1]) / slide);
    Func f;
    f(x, y) = Halide::Tuple(p[0], select(below, height, p[1]), p[2], select(below, grip * v[0], v[0]),
                            select(below, rebound, v[1]), select(below, grip * v[2], v[2]));
    return f;
  }

  /// The pipeline of so many steps, and its schedule. Tried on Zen 4 and not faster: springs with the forces
  /// of both ends kept, one window for all springs or one for each, tiles of columns, two rows at once,
  /// vectors of eight, estimates of roots, more steps in a pass.
  Halide::Callable compiled(int steps) const {
    Halide::ImageParam in(Halide::Float(32), 3, "in"), free(Halide::Float(32), 2, "free");
    in.dim(0).set_min(-margin);
    in.dim(1).set_bounds(0, 6).set_stride(pitch_);
    in.dim(2).set_min(-ring).set_stride(6 * pitch_);
    free.dim(0).set_min(-margin);
    free.dim(1).set_min(-ring).set_stride(pitch_);
    struct Step {
      std::array<Func, 2> pull;
      Func acceleration, moved;
    };
    std::vector<Step> all;
    for (int s = 0; s < steps; ++s) {
      const auto state = [&, before = s == 0 ? Func() : all.back().moved](const Expr& column, const Expr& row,
                                                                          int component) -> Expr {
        return before.defined() ? Expr(before(column, row)[component]) : in(column, component, row);
      };
      Step step;
      for (std::size_t group : {0, 1}) step.pull[group] = pulls(state, springs[group]);
      step.acceleration = acceleration(state, step.pull);
      step.moved = moved(state, step.acceleration, free);
      all.push_back(step);
    }

    Func out = all.back().moved;
    Var strip, row, lane;
    const int vector = Halide::get_host_target().natural_vector_size<float>();
    out.bound(x, 0, padded_).bound(y, 0, rows_);
    out.output_buffers()[0].dim(0).set_min(0);
    out.output_buffers()[0].dim(1).set_min(0);
    for (Halide::OutputImageParam& buffer : out.output_buffers()) {
      buffer.dim(1).set_stride(6 * pitch_);
      buffer.set_host_alignment(64);
    }
    in.set_host_alignment(64);
    free.set_host_alignment(64);
    out.split(y, strip, row, (rows_ + threads_ - 1) / threads_);
    if (threads_ > 1) out.parallel(strip);
    for (Step& step : all) {
      for (Func& pull : step.pull) pull.store_at(out, strip).compute_at(out, row).vectorize(x, vector);
      step.moved.split(x, x, lane, vector).vectorize(lane);
      if (&step != &all.back()) step.moved.store_at(out, strip).compute_at(out, row);
      // In registers; without it LLVM computes all of it again for each component of the state.
      step.acceleration.compute_at(step.moved, x).vectorize(x, vector);
    }
    return out.compile_to_callable({in, free});
  }

  const Var x{"x"}, y{"y"};
  int rows_, columns_, padded_,
      pitch_;               // padded_: columns; pitch_: floats from a component of a row to the next
  int threads_, pass_ = 1;  // pass_: steps
  double dt_;
  float viscous_, gravity_;
  mssim_backend::Floor floor_;
  std::array<float, 3> stiffness_{}, rest_{}, damping_{};  // by kind; stiffness and damping over the mass
  std::size_t now_ = 0;
  std::array<Floats, 2> states_;  // [rows + 2 ring][x y z u v w][pitch]
  Floats free_;                   // [rows + 2 ring][pitch] 1 where a node moves, else 0
  std::array<Buffer, 2> from_;
  std::array<std::array<Buffer, 6>, 2> to_;
  Buffer free_buffer_;
  Halide::Callable one_step_, one_pass_;
};

}  // namespace

int main() {
  return mssim_backend::serve([](const mssim_backend::System& system, const mssim_backend::Method& method) {
    if (method.name != "semi-euler") throw mssim_backend::Unsupported("semi-euler only");
    if (!system.grid) throw mssim_backend::Unsupported("this one is written for cloths");
    return std::make_unique<Cloth>(system);
  });
}
