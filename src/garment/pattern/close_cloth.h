#pragma once

#include <string>
#include <vector>

#include "garment/garment.h"

namespace mssim {

/// What of a pattern is to lie close to the body: cloth beside these seams.
struct CloseSeams {
  std::vector<std::string> seams;  ///< their names
  double reach = 0;                ///< m, how far beside a seam, along a row in the flat pattern
  double lowest = 0, highest = 0;  ///< m, heights on the body, both included
};

/// The nodes of these seams, and those of the same rows within the reach, each once and in rising order.
/// `garment` has panels, seams, joints and where its nodes lie flat.
CloseCloth close_cloth(const CloseSeams& close, const Garment& garment);

}  // namespace mssim
