#pragma once

#include <memory>

#include "garment/body/body_profile.h"
#include "garment/fitting/fitting.h"

namespace mssim {

/// A body to measure fits against: the mesh of its trunk and legs, which is what garments meet; for how far
/// cloth stands off, all of it.
FitBody fit_body(const std::shared_ptr<const MeasuredBody>& body);

}  // namespace mssim
