#include "ranks/piece.h"

#include "ranks/bodies_piece.h"
#include "ranks/cloth_piece.h"
#include "ranks/copies_piece.h"

namespace mssim {

namespace {

[[noreturn]] void refuse_windows() { throw RankFailure("mssim asks for windows of what is no cloth"); }

}  // namespace

void Piece::restart(double) { refuse_windows(); }
std::vector<NodeRun> Piece::owned_by(int, const GridWindow&) const { refuse_windows(); }
State Piece::state(const GridWindow&) const { refuse_windows(); }

void require_cut(const SceneSpec& scene, const Integrator& integrator, int ranks) {
  if (const auto* cloth = std::get_if<ClothSpec>(&scene.content))
    require_columns(cloth->columns, integrator, ranks);
  else if (std::holds_alternative<BodiesSpec>(scene.content))
    require_shares(scene, ranks);
}

std::unique_ptr<Piece> make_piece(const Session& session, const RankJob& job) {
  const bool is_cloth = std::holds_alternative<ClothSpec>(job.scene.content);
  const bool has_bodies = std::holds_alternative<BodiesSpec>(job.scene.content);
  if (!is_cloth && !has_bodies) throw Unsupported("it steps cloths and bodies");
  if (job.copies) return std::make_unique<CopiesPiece>(session, job);
  if (is_cloth) return std::make_unique<ClothPiece>(session, job);
  return std::make_unique<BodiesPiece>(session, job);
}

}  // namespace mssim
