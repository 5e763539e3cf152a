#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "garment/spec/garment_spec.h"
#include "model/spring.h"
#include "model/system.h"
#include "scene/spec/bodies_spec.h"

namespace mssim {

/// The nodes of a cloth that stay where they start: of one row every `every_columns`-th, and its last one.
struct ClothPins {
  std::uint32_t row = 0;
  std::uint32_t every_columns = 1;
};

/// A standing wave at the start of a cloth, so that every spring works from the first step on.
struct ClothRipple {
  double height_m = 0;  ///< amplitude of the vertical displacement; in the plane it is half of that
  double wavelength_m = 1;
  double speed_m_per_s = 0;  ///< amplitude of every component of the velocity
};

/// A regular cloth that hangs by some nodes of one row from the ceiling, level at first. Row r, column c
/// starts at (c spacing, ceiling height, r spacing), plus the ripple.
struct ClothSpec {
  std::uint32_t rows = 0;
  std::uint32_t columns = 0;
  double spacing_m = 0;
  double areal_density_kg_per_m2 = 0;  ///< a node weighs areal density times spacing squared
  double ceiling_height_m = 0;

  std::optional<ClothPins> pins;  ///< none: the cloth falls freely

  ClothRipple ripple;
  std::array<SpringMaterial, grid_spring_kinds.size()> springs;  ///< by GridSpringKind
};

/// A scene as its file describes it.
struct SceneSpec {
  std::string name;            ///< the file's name without .json, escaped() where it has to be
  std::string description;     ///< one line
  std::optional<double> dt_s;  ///< empty: `auto`, from the stability limit
  double gravity_m_per_s2 = 0;
  double viscous_damping_per_s = 0;
  Floor floor;
  SolverSettings solver;
  std::variant<ClothSpec, BodiesSpec, GarmentSpec>
      content;                 ///< one alternative a scene kind, in the order of their table (scene_kinds.h)
  std::string source;          ///< the file's text, for traces and hashes
  std::filesystem::path file;  ///< where it was read, for messages
};

/// The size of a scene as the tables state it.
struct SceneCounts {
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;  ///< each spring once
  /// As Hong et al. count them; how, depends on the scene kind. None for a kind that they do not have.
  std::optional<std::uint64_t> springs_published = {};
};

}  // namespace mssim
