#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "garment/body/mannequin.h"
#include "garment/body/stance.h"
#include "garment/cloth_layers.h"
#include "garment/dressing.h"
#include "garment/pattern/garment_build.h"
#include "garment/pattern/jeans.h"
#include "garment/spec/garment_pieces.h"
#include "mesh/meshing.h"

namespace mssim {

/// A dress form made from measures.
struct MannequinBody {
  BodyMeasures measures;
  MannequinResolution resolution;
};

/// A surface in an OBJ or STL file. Paths that are not absolute start at the scene file's folder.
struct BodyFile {
  std::string file;
  BodyStance stance;
  std::optional<double> close_holes_m;  ///< size of the largest opening that is closed; none: there are none
};

/// Jeans that fit the body: what the body itself says, its girths and the height of its crotch, is measured.
struct JeansSpec {
  std::uint32_t nodes = 0;  ///< about
  JeansMeasures measures;
};

/// A body, a garment for it, and how it is dressed.
struct GarmentSpec {
  std::variant<MannequinBody, BodyFile> body;
  double pixel_m = 0.0025;  ///< of the maps of the body
  double skin_m = 0.003;    ///< that the maps lie before the body's surface, beside what coarse cloth needs
  std::optional<JeansSpec> jeans;
  std::optional<PiecesSpec> pieces;  ///< one or both of the two
  PanelMaterial cloth;               ///< of jeans, and of pieces that have none of their own
  DressingSettings dressing;
  std::optional<ClothClothSettings> layers;  ///< that touch each other; none: they go through each other
  std::optional<MeshSize> expected;
};

}  // namespace mssim
