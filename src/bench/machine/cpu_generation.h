#pragma once

#include <string_view>

namespace mssim {

/// What a processor says of itself in /proc/cpuinfo. On x86-64 `maker` is the vendor's identification; on Arm
/// it is the implementer's number as the kernel writes it ("0x41"), `model` the part's, and `family` zero.
struct CpuIdentification {
  std::string_view maker;
  int family = 0;
  int model = 0;
};

/// The design behind the name, for example "Zen 4" or "Sapphire Rapids": names such as "AMD EPYC", which
/// virtual machines often give, say nothing of how fast a processor is. Empty where the table has none.
std::string_view cpu_generation(const CpuIdentification& cpu);

}  // namespace mssim
