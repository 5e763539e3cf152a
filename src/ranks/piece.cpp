#include "ranks/piece.h"

#include "ranks/bodies_piece.h"
#include "ranks/cloth_piece.h"

namespace mssim {

namespace {

[[noreturn]] void refuse_windows() { throw RankFailure("mssim asks for windows of what is no cloth"); }

}  // namespace

void Piece::restart(double) { refuse_windows(); }
std::vector<NodeRun> Piece::owned_by(int, const GridWindow&) const { refuse_windows(); }
State Piece::state(const GridWindow&) const { refuse_windows(); }

std::unique_ptr<Piece> make_piece(const Session& session, const RankJob& job) {
  if (std::holds_alternative<ClothSpec>(job.scene.content)) return std::make_unique<ClothPiece>(session, job);
  if (std::holds_alternative<BodiesSpec>(job.scene.content))
    return std::make_unique<BodiesPiece>(session, job);
  throw Unsupported("it steps cloths and bodies");
}

}  // namespace mssim
