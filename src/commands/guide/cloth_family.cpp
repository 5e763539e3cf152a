#include "commands/guide/cloth_family.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "platform/files.h"
#include "scene/scene_kinds.h"

namespace mssim {
namespace {

/// With that many nodes along a side; its text says so too.
SceneSpec with_side(SceneSpec spec, std::uint32_t side) {
  auto& cloth = std::get<ClothSpec>(spec.content);
  const double height = cloth.ceiling_height_m - spec.floor.height;
  cloth.ceiling_height_m = spec.floor.height + height * (side - 1) / (cloth.rows - 1);
  cloth.rows = cloth.columns = side;
  if (cloth.pins) cloth.pins->row = 0;
  nlohmann::json text = nlohmann::json::parse(spec.source);
  nlohmann::json& fields = text.at("cloth");
  fields["rows"] = fields["columns"] = side;
  fields["ceiling_height_m"] = cloth.ceiling_height_m;
  if (cloth.pins) fields["pins"]["row"] = 0;
  spec.source = text.dump();
  return spec;
}

}  // namespace

ClothMaker cloth_family(const SceneSpec& spec) {
  const auto* cloth = std::get_if<ClothSpec>(&spec.content);
  if (cloth == nullptr || cloth->rows < 2) return {};
  return [spec, folder = std::make_shared<TemporaryFolder>()](std::uint32_t side) {
    const SceneSpec one = with_side(spec, side);
    FamilyCloth made{build_system(one), folder->path() / (std::to_string(side) + ".json")};
    write_file_atomically(made.file, one.source);
    return made;
  };
}

bool same_family(const SceneSpec& a, const SceneSpec& b) {
  const auto *one = std::get_if<ClothSpec>(&a.content), *other = std::get_if<ClothSpec>(&b.content);
  if (one == nullptr || other == nullptr) return false;
  const auto same_springs = [&] {
    for (std::size_t kind = 0; kind < one->springs.size(); ++kind)
      if (one->springs[kind].stiffness != other->springs[kind].stiffness ||
          one->springs[kind].damping != other->springs[kind].damping)
        return false;
    return true;
  };
  return one->spacing_m == other->spacing_m &&
         one->areal_density_kg_per_m2 == other->areal_density_kg_per_m2 && same_springs() &&
         a.gravity_m_per_s2 == b.gravity_m_per_s2 && a.viscous_damping_per_s == b.viscous_damping_per_s;
}

}  // namespace mssim
