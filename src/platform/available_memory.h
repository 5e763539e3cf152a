#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mssim {

/// Bytes that this process can still get: what the kernel calls available, or what the address-space limit
/// (`ulimit -v`) or
/// a container's limit leaves if that is less.
std::uint64_t available_memory();

/// "needs at least 3.20 GB of memory, but 1.00 GB are available", in as many digits as tell the two apart;
/// none where the available memory suffices. Both in bytes.
std::optional<std::string> memory_shortage(std::uint64_t needed, std::uint64_t available);

/// The same of what is available now.
std::optional<std::string> memory_shortage(std::uint64_t needed);

}  // namespace mssim
