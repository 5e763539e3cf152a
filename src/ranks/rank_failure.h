#pragma once

#include <stdexcept>

namespace mssim {

/// Why this run over several processes cannot go on; what() is a sentence that
/// names other ranks with their hosts, and calls this one "it".
struct RankFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mssim
