#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "backends/interface/window_backend.h"
#include "bench/verification/blow_up.h"
#include "bench/verification/verification.h"
#include "bench/windows/window_reference.h"

namespace mssim {

/// The first node of the windows that is not finite, by its number in the whole cloth.
std::optional<std::size_t> first_bad_node(const WindowBackend& backend, const WindowedCloth& cloth);

/// The first step of so many from the scene's start after which a window is not finite.
std::optional<BlowUp> find_blow_up(WindowBackend& backend, const WindowedCloth& cloth, int steps);

/// Compares the backend, so many steps after the scene's start, in every window; at most reference.steps, and
/// one of window_looks. The position error is that of the worst node, each window has a tolerance of its own,
/// and the energy is that of all windows together. There is no hash of the state. Leaves the backend in any
/// state.
Verification compare_windows(WindowBackend& backend, const WindowedCloth& cloth, const Integrator& integrator,
                             const WindowReferences& reference, int steps, double dt_s);

/// Steps the backend from the scene's start, as far as there is a reference, and compares it.
Verification verify_windows(WindowBackend& backend, const WindowedCloth& cloth, const Integrator& integrator,
                            const WindowReferences& reference, double dt_s);

/// "verified in 9 windows, 0.4 % of the nodes".
std::string share_seen(const WindowedCloth& cloth);

}  // namespace mssim
