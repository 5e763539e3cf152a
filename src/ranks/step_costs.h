#pragma once

#include <string>
#include <vector>

#include "ranks/link_speed.h"
#include "ranks/piece.h"
#include "ranks/session.h"

namespace mssim {

/// What the steps of all ranks cost since they were last told: the answers to the request `costs`
/// (docs/own-backends.md).
class StepCosts {
 public:
  explicit StepCosts(const LinkSpeed& links) : links_(links) {}

  /// Takes steps with the piece, until all ranks have.
  void step(const Session& session, Piece& piece, int count);
  /// The lines of the answer, on all ranks, which call this together.
  std::vector<std::string> tell(const Session& session, const Piece& piece);

 private:
  LinkSpeed links_;
  RankCosts told_;      ///< what the piece said when it was last asked
  double seconds_ = 0;  ///< of the steps since then
  double met_s_ = 0;    ///< of these, waiting for others at their end
  double steps_ = 0;
};

}  // namespace mssim
