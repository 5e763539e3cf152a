// C++ with care for vectors (cloths only): each node gathers its springs; a component of a row lies by
// itself, with a ring of nodes around the cloth in place of conditions; a loop over a row of which the
// compiler makes vector instructions, the edges, where springs are missing, apart; two states that take
// turns, and rows shared among threads.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "mssim_backend.h"

namespace {

struct Spring {
  int rows, columns, kind;  // to the other end; 0 structural, 1 shear, 2 bending
};
constexpr std::array<Spring, 12> springs{{{0, 1, 0},
                                          {1, 0, 0},
                                          {1, 1, 1},
                                          {1, -1, 1},
                                          {0, 2, 2},
                                          {2, 0, 2},
                                          {0, -1, 0},
                                          {-1, 0, 0},
                                          {-1, -1, 1},
                                          {-1, 1, 1},
                                          {0, -2, 2},
                                          {-2, 0, 2}}};
constexpr int ring = 2, vector = 16, margin = vector;
constexpr int edge_rows = 2 * ring + 1;  // the first two, an inner one, the last two

using Floats = std::vector<float>;

/// Where the first line of cache begins, for which a vector of floats has room.
float* aligned(Floats& floats) {
  constexpr std::uintptr_t line = vector * sizeof(float);
  return floats.data() +
         (line - reinterpret_cast<std::uintptr_t>(floats.data()) % line) % line / sizeof(float);
}

class Cloth : public mssim_backend::Backend {
 public:
  explicit Cloth(const mssim_backend::System& system)
      : threads_(system.threads),
        rows_(static_cast<int>(system.grid->rows)),
        columns_(static_cast<int>(system.grid->columns)),
        pitch_((margin + columns_ + ring + vector - 1) / vector * vector + vector),
        dt_(static_cast<float>(system.dt)),
        viscous_(static_cast<float>(system.viscous_damping)),
        gravity_(static_cast<float>(system.gravity[1])),
        height_(static_cast<float>(system.floor.height)),
        restitution_(static_cast<float>(system.floor.restitution)),
        friction_(static_cast<float>(system.floor.friction)),
        state_(static_cast<std::size_t>(6 * pitch_) * static_cast<std::size_t>(rows_ + 2 * ring) + vector),
        next_(state_.size()),
        free_(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(pitch_), 1),
        exists_(static_cast<std::size_t>(edge_rows) * springs.size() * static_cast<std::size_t>(pitch_)) {
    for (std::size_t s = 0; s < system.springs.size(); ++s) {
      const std::size_t kind = system.kind[s];
      const double mass = system.mass[0];
      stiffness_[kind] = static_cast<float>(system.stiffness[s] / mass);
      rest_[kind] = static_cast<float>(system.stiffness[s] * system.rest_length[s] / mass);
      damping_[kind] = static_cast<float>(system.damping[s] / mass);
    }
    for (const std::uint32_t pin : system.pins) free_[at(static_cast<int>(pin))] = 0;
    for (int edge = 0; edge < edge_rows; ++edge)
      for (std::size_t s = 0; s < springs.size(); ++s)
        for (int column = 0; column < columns_; ++column) {
          const int row = edge < ring    ? edge
                          : edge == ring ? std::min(ring, rows_ - 1)
                                         : rows_ - edge_rows + edge;
          const int other_row = row + springs[s].rows, other = column + springs[s].columns;
          const bool there = other_row >= 0 && other_row < rows_ && other >= 0 && other < columns_;
          exists_[weight(edge, s) + static_cast<std::size_t>(column)] = there ? 1 : 0;
        }
    // The nodes of the ring stand far from all others, that no spring to them has the length zero.
    for (Floats* all : {&state_, &next_})
      for (std::ptrdiff_t row = 0; row < rows_ + 2 * ring; ++row)
        for (std::ptrdiff_t i = 0; i < pitch_; ++i)
          aligned(*all)[row * 6 * pitch_ + i] = 1e3F * (1 + static_cast<float>(i));
    about.precision = "single";
    about.note = PEER_NOTE;  // compiler, settings and the lines of this file, from whoever compiles it
  }

  void set(const mssim_backend::Vectors& x, const mssim_backend::Vectors& v) override {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        for (std::size_t i = 0; i < 3; ++i) {
          const auto node = static_cast<std::size_t>(row * columns_ + column);
          float* to = row_of(state_, row) + column;
          to[static_cast<std::ptrdiff_t>(i) * pitch_] = static_cast<float>(x[node][i]);
          to[static_cast<std::ptrdiff_t>(i + 3) * pitch_] = static_cast<float>(v[node][i]);
        }
  }

  void get(mssim_backend::Vectors& x, mssim_backend::Vectors& v) override {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column)
        for (std::size_t i = 0; i < 3; ++i) {
          const auto node = static_cast<std::size_t>(row * columns_ + column);
          const float* from = row_of(state_, row) + column;
          x[node][i] = from[static_cast<std::ptrdiff_t>(i) * pitch_];
          v[node][i] = from[static_cast<std::ptrdiff_t>(i + 3) * pitch_];
        }
  }

  void step(int count) override {
#pragma omp parallel num_threads(threads_)
    for (int step = 0; step < count; ++step) {
#pragma omp for schedule(static)
      for (int row = 0; row < rows_; ++row) step_row(row);
#pragma omp single
      std::swap(state_, next_);
    }
  }

 private:
  std::size_t at(int node) const {
    return static_cast<std::size_t>(node / columns_ * pitch_ + node % columns_);
  }
  std::size_t weight(int edge, std::size_t spring) const {
    return (static_cast<std::size_t>(edge) * springs.size() + spring) * static_cast<std::size_t>(pitch_);
  }
  /// The first node of a row, its x.
  float* row_of(Floats& all, int row) const {
    return aligned(all) + static_cast<std::ptrdiff_t>(row + ring) * 6 * pitch_ + margin;
  }

  void step_row(int row) {
    const float* from = row_of(state_, row);
    float* to = row_of(next_, row);
    const int edge = row < ring ? row : std::max(ring, row - rows_ + edge_rows);
    const auto all = std::make_index_sequence<springs.size()>();
    if (edge != ring || columns_ < 2 * vector) {
      move<true>(all, from, to, row, edge, 0, columns_);
    } else {
      move<true>(all, from, to, row, edge, 0, vector);
      move<false>(all, from, to, row, edge, vector, columns_ - vector);
      move<true>(all, from, to, row, edge, columns_ - vector, columns_);
    }
    float lowest = std::numeric_limits<float>::max();
#pragma omp simd reduction(min : lowest)
    for (int i = 0; i < columns_; ++i) lowest = std::min(lowest, to[pitch_ + i]);
    if (lowest < height_) land(to, row);
  }

  template <bool weighted, std::size_t... s>
  void move(std::index_sequence<s...>, const float* __restrict from, float* __restrict to, int row, int edge,
            int begin, int end) const {
    const std::ptrdiff_t p = pitch_;
    const std::array<float, 3> k = stiffness_, l = rest_, c = damping_;
    const float dt = dt_, viscous = viscous_, gravity = gravity_;
    const float* const free = free_.data() + row * p;
    const float* const exists = exists_.data() + weight(edge, 0);
#pragma omp simd
    for (int i = begin; i < end; ++i) {
      const float x = from[i], y = from[p + i], z = from[2 * p + i];
      const float u = from[3 * p + i], v = from[4 * p + i], w = from[5 * p + i];
      float ax = 0, ay = 0, az = 0;
      const auto pull = [&](const Spring& spring, std::size_t number) __attribute__((always_inline)) {
        const float* const other = from + spring.rows * 6 * p + spring.columns + i;
        const float dx = other[0] - x, dy = other[p] - y, dz = other[2 * p] - z;
        const float closing = (other[3 * p] - u) * dx + (other[4 * p] - v) * dy + (other[5 * p] - w) * dz;
        const float inverse = 1 / std::sqrt(dx * dx + dy * dy + dz * dz);
        const auto kind = static_cast<std::size_t>(spring.kind);
        float force = k[kind] + (c[kind] * closing * inverse - l[kind]) * inverse;
        if (weighted) force *= exists[static_cast<std::ptrdiff_t>(number) * p + i];
        ax += force * dx;
        ay += force * dy;
        az += force * dz;
      };
      (pull(springs[s], s), ...);
      const float h = dt * free[i];
      const float new_u = u + h * (ax - viscous * u), new_v = v + h * (ay - viscous * v + gravity);
      const float new_w = w + h * (az - viscous * w);
      to[i] = x + dt * new_u;
      to[p + i] = y + dt * new_v;
      to[2 * p + i] = z + dt * new_w;
      to[3 * p + i] = new_u;
      to[4 * p + i] = new_v;
      to[5 * p + i] = new_w;
    }
  }

  void land(float* to, int row) const {
    for (int i = 0; i < columns_; ++i) {
      float &y = to[pitch_ + i], &u = to[3 * pitch_ + i], &v = to[4 * pitch_ + i], &w = to[5 * pitch_ + i];
      if (y >= height_ || free_[at(row * columns_ + i)] == 0) continue;
      const float rebound = v < 0 ? -restitution_ * v : v;
      const float slide = std::sqrt(u * u + w * w + 1e-30F);
      const float grip = std::max(0.0F, 1 - friction_ * (rebound - v) / slide);
      y = height_;
      u *= grip;
      v = rebound;
      w *= grip;
    }
  }

  int threads_, rows_, columns_;
  std::ptrdiff_t pitch_;  // floats from a component of a row to the next
  float dt_, viscous_, gravity_, height_, restitution_, friction_;
  std::array<float, 3> stiffness_{}, rest_{}, damping_{};  // by kind, over the mass
  Floats state_, next_;                                    // [rows + 4][x y z u v w][pitch]
  Floats free_;                                            // [rows][pitch] 0 where a node is pinned, else 1
  Floats exists_;  // [edge_rows][springs][pitch] 1 where there is one, else 0
};

}  // namespace

int main() {
  return mssim_backend::serve([](const mssim_backend::System& system, const mssim_backend::Method& method) {
    if (method.name != "semi-euler") throw mssim_backend::Unsupported("semi-euler only");
    if (!system.grid) throw mssim_backend::Unsupported("this one is written for cloths");
    return std::make_unique<Cloth>(system);
  });
}
