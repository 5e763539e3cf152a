#pragma once

#include <string_view>

namespace mssim {

/// Whether an instruction set, by Highway's name, has multiply-adds, which round once where a product and a
/// sum round twice.
inline bool fuses(std::string_view instruction_set) {
  return instruction_set == "AVX3" || instruction_set == "AVX2" || instruction_set == "NEON";
}

}  // namespace mssim
