#pragma once

#include <span>
#include <string>
#include <string_view>

#include "backends/backend.h"

namespace mssim {

/// The TABLE of backends, in the order of every listing and result. A new backend is one row in backends.cpp.
std::span<const BackendInfo> backends();

/// The backend of that name, or nullptr.
const BackendInfo* find_backend(std::string_view name);

/// Empty when the backend can run here, else the reason why not.
std::string unavailable_reason(const BackendInfo& backend, const ExecutionOptions& options);

/// Whether the backend has Algorithm 1 (dressing/); one that has not refuses garments.
bool dresses(const BackendInfo& backend);

/// What a reader of its times must know of a backend that takes more processors than `threads`, which it was
/// made for; empty for all others.
std::string excess_of(const Backend& backend, int threads);

}  // namespace mssim
