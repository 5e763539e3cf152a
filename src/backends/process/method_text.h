#pragma once

#include <string>

#include "integrators/integrator.h"

namespace mssim {

/// An integrator in the lines of the protocol: its name, and for each stage "stage x v" and its assignments,
/// "assign OUT" and the terms of the sum, each a coefficient, a power of dt and a slot.
std::string method_text(const Integrator& integrator);

}  // namespace mssim
