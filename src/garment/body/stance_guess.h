#pragma once

#include <optional>
#include <string>
#include <vector>

#include "garment/body/body_stance.h"

namespace mssim {

/// What is known of how a file has its body.
struct GivenStance {
  std::optional<double> unit_m;
  std::optional<UpAxis> up;
  std::optional<Facing> facing;
};

/// How a file seems to have its body.
struct StanceGuess {
  BodyStance stance;
  /// One sentence for each part of it that is not certain, which begins with that part's name.
  std::vector<std::string> doubts;
};

/// Finds unit, upright axis and facing of a body, which need not be closed, and keeps what is given. The unit
/// is that in which it is a person's height. Its legs, which stand side by side below, tell the upright axis
/// and the sideways one, and its toes where it looks. Legs that stand askew have it turned in whole degrees.
/// It is moved so that the gap between its legs is at x = 0, its feet stand on y = 0 and its middle in depth
/// is z = 0, to a tenth of a millimetre. Throws InputError, which says what to give, for a body that is a
/// person in no unit, for one that lies, and for a facing that is given along the upright axis.
StanceGuess guess_stance(const Surface& body, const GivenStance& given);

}  // namespace mssim
