#include "bench/machine/cpu_generation.h"

#include <algorithm>
#include <iterator>

namespace mssim {
namespace {

constexpr std::string_view amd = "AuthenticAMD", intel = "GenuineIntel", arm = "0x41";

struct Generation {
  std::string_view maker;
  int family;
  int first_model, last_model;
  std::string_view name;
};

/// The numbers are those that the kernel tells processors apart by (arch/x86/kernel/cpu/amd.c and
/// asm/intel-family.h) and Arm's main ID registers.
constexpr Generation generations[]{
    {amd, 0x17, 0x00, 0x2f, "Zen"},           {amd, 0x17, 0x50, 0x5f, "Zen"},
    {amd, 0x17, 0x30, 0x4f, "Zen 2"},         {amd, 0x17, 0x60, 0x7f, "Zen 2"},
    {amd, 0x17, 0x90, 0xaf, "Zen 2"},         {amd, 0x19, 0x00, 0x0f, "Zen 3"},
    {amd, 0x19, 0x20, 0x5f, "Zen 3"},         {amd, 0x19, 0x10, 0x1f, "Zen 4"},
    {amd, 0x19, 0x60, 0xaf, "Zen 4"},         {amd, 0x1a, 0x00, 0x4f, "Zen 5"},
    {amd, 0x1a, 0x60, 0x7f, "Zen 5"},         {intel, 6, 0x3f, 0x3f, "Haswell"},
    {intel, 6, 0x4f, 0x4f, "Broadwell"},      {intel, 6, 0x55, 0x55, "Skylake or Cascade Lake"},
    {intel, 6, 0x6a, 0x6a, "Ice Lake"},       {intel, 6, 0x6c, 0x6c, "Ice Lake"},
    {intel, 6, 0x8c, 0x8d, "Tiger Lake"},     {intel, 6, 0x8f, 0x8f, "Sapphire Rapids"},
    {intel, 6, 0x97, 0x97, "Alder Lake"},     {intel, 6, 0x9a, 0x9a, "Alder Lake"},
    {intel, 6, 0xad, 0xae, "Granite Rapids"}, {intel, 6, 0xb7, 0xb7, "Raptor Lake"},
    {intel, 6, 0xcf, 0xcf, "Emerald Rapids"}, {arm, 0, 0xd0c, 0xd0c, "Neoverse N1"},
    {arm, 0, 0xd40, 0xd40, "Neoverse V1"},    {arm, 0, 0xd49, 0xd49, "Neoverse N2"},
    {arm, 0, 0xd4f, 0xd4f, "Neoverse V2"},
};

}  // namespace

std::string_view cpu_generation(const CpuIdentification& cpu) {
  const auto found = std::ranges::find_if(generations, [&](const Generation& generation) {
    return generation.maker == cpu.maker && generation.family == cpu.family &&
           cpu.model >= generation.first_model && cpu.model <= generation.last_model;
  });
  return found == std::end(generations) ? std::string_view() : found->name;
}

}  // namespace mssim
