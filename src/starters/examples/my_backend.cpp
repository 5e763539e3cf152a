// A backend of mssim. To compile it, and to time and verify it:
//     c++ -std=c++17 -O3 my_backend.cpp $(pkg-config --cflags --libs hdf5) -o my_backend
//     mssim bench --scene cloth2500 --backend serial,openmp,./my_backend
#include <cmath>
#include <cstddef>

#include "mssim_backend.h"

using mssim_backend::Vectors;

int main() {
  return mssim_backend::serve([](const mssim_backend::System& system, const mssim_backend::Method& method) {
    const auto acceleration = [&system](const Vectors& x, const Vectors& v, Vectors& a) {
      for (std::size_t i = 0; i < system.nodes(); ++i)
        for (std::size_t k = 0; k < 3; ++k) a[i][k] = system.gravity[k] - system.viscous_damping * v[i][k];
      for (std::size_t s = 0; s < system.springs.size(); ++s) {
        const auto [first, second] = system.springs[s];
        double d[3], length_squared = 0, closing = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          d[k] = x[second][k] - x[first][k];
          length_squared += d[k] * d[k];
          closing += d[k] * (v[second][k] - v[first][k]);
        }
        const double length = std::sqrt(length_squared);
        const double stretch = system.stiffness[s] * (length - system.rest_length[s]);  // N
        const double pull = (stretch + system.damping[s] * closing / length) / length;  // N/m
        for (std::size_t k = 0; k < 3; ++k) {
          a[first][k] += pull * d[k] / system.mass[first];
          a[second][k] -= pull * d[k] / system.mass[second];
        }
      }
    };
    auto backend = mssim_backend::stepped_by(system, method, acceleration);
    backend->about.threads = 1;
    return backend;
  });
}
