#include "statistics/looks.h"

namespace mssim {

Look look_at(std::size_t pairs) {
  std::size_t due = first_look_pairs, number = 1;
  for (; due < pairs; due += due / 2) ++number;
  return {due, 1 / static_cast<double>(number * (number + 1))};
}

}  // namespace mssim
