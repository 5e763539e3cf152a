#include "ranks/piece.h"

#include "ranks/bodies_piece.h"
#include "ranks/cloth_piece.h"

namespace mssim {

std::unique_ptr<Piece> make_piece(const Session& session, const RankJob& job) {
  if (std::holds_alternative<ClothSpec>(job.scene.content)) return std::make_unique<ClothPiece>(session, job);
  if (std::holds_alternative<BodiesSpec>(job.scene.content))
    return std::make_unique<BodiesPiece>(session, job);
  throw Unsupported("it steps cloths and bodies");
}

}  // namespace mssim
