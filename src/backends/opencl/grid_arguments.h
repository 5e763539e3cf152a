#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <span>
#include <vector>

#include "kernels/grid_parameters.h"
#include "model/system.h"
#include "model/topology.h"

namespace mssim {

/// What the kernels of both shapes are told about a cloth.
GridParameters grid_parameters_of(const System& system, const GridPatch& patch);

/// Masks of numbers, one for every row or column that differs from the others.
struct Masks {
  std::vector<cl_int> mask_of;  ///< [rows or columns] a mask, or a negative number
  std::vector<cl_int> numbers;  ///< [masks][length]
  std::size_t length;

  Masks(std::size_t count, std::size_t mask_length) : mask_of(count, -1), length(mask_length) {}

  /// The mask of a row or column; made from `model` where there is none.
  std::span<cl_int> mask(std::size_t number, const std::vector<cl_int>& model) {
    if (mask_of[number] < 0) {
      mask_of[number] = static_cast<cl_int>(numbers.size() / length);
      numbers.insert(numbers.end(), model.begin(), model.end());
    }
    return std::span(numbers).subspan(static_cast<std::size_t>(mask_of[number]) * length, length);
  }
};

}  // namespace mssim
