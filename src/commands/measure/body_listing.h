#pragma once

#include <span>
#include <string>

#include "garment/body/body_profile.h"
#include "garment/body/stance.h"
#include "geometry/surface.h"
#include "output/tables/table.h"

namespace mssim {

/// What `mssim measure` has found of a body: rows of measure, value, unit and note.
class BodyListing {
 public:
  /// `how` it is known, the same for all three.
  void add_stance(const BodyStance& stance, const std::string& how);
  /// `what` has been done about them.
  void add_openings(std::span<const Opening> openings, const std::string& what);
  void add_measures(const BodyProfile& profile, const BodyLandmarks& landmarks);

  const Table& rows() const { return rows_; }

 private:
  void add(const std::string& measure, Cell value, const std::string& unit, const std::string& note = {});
  void add_landmark(const std::string& name, const Landmark& landmark);

  Table rows_;
};

}  // namespace mssim
