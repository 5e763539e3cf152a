// The results of serial and openmp to the last bit, as hashes of the state after 100 steps. They are the same
// on every processor, because nothing is contracted and the order of every sum is the scene's; openmp has
// two, as instruction sets with multiply-adds round once where others round twice. Instruction sets without
// exact roots are left out: their bits are the processor's.
//
// A change that is not meant to change results leaves these hashes as they are. After one that is, put here
// what the failing test prints, and say in the commit why the results differ.

#include "backends/openmp/openmp.h"
#include "backends/spring_list/list_backends.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "model/system.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/dressing_systems.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Of a state in hexadecimal digits, as in the column state_hash of timings.csv.
struct Hashes {
  const char* serial;
  const char* fused;      ///< openmp with multiply-adds
  const char* not_fused;  ///< openmp without
};

std::string hash_after_100_steps(Backend& backend) {
  backend.step(100);
  return to_hex(state_hash(backend.state()));
}

const Integrator& semi_euler() { return *find_integrator("semi-euler"); }
const Integrator& rk4() { return *find_integrator("rk4"); }

void expect_hashes(const System& system, const Integrator& integrator, double dt_s, const Hashes& expected) {
  EXPECT_EQ(hash_after_100_steps(*make_serial(system, integrator, dt_s, {1, ""})), expected.serial);
  std::size_t held = 0;
  for (const std::string_view set : openmp_instruction_sets()) {
    if (!has_exact_roots(set)) continue;
    ++held;
    for (const int threads : {1, 3})
      EXPECT_EQ(hash_after_100_steps(*make_openmp(system, integrator, dt_s,
                                                  {.threads = threads, .instruction_set = std::string(set)})),
                fuses(set) ? expected.fused : expected.not_fused)
          << set << ", " << threads << " threads";
  }
  EXPECT_GT(held, 0U);
}

TEST(GoldenBits, OfACloth) {
  const SceneSpec spec = find_scene("cloth2500");
  const System system = build_system(spec);
  expect_hashes(system, semi_euler(), spec.dt_s.value(),
                {"89bd746c9f6facb8", "feb85787eb7f62f2", "17655c8894bc3c06"});
  expect_hashes(system, rk4(), spec.dt_s.value(),
                {"5bf3c6f49410f2b3", "2bf202a6abb994d9", "39389486022f23d7"});
}

TEST(GoldenBits, OfABodyThatMeetsTheFloor) {
  const System system = solid_block(9, 9, 9, 0.001);
  expect_hashes(system, semi_euler(), 1e-4, {"77929686ac01f09d", "bb9f143a5384af0c", "5ec6b80ca6da8f3c"});
  expect_hashes(system, rk4(), 1e-4, {"ea21500d4265ad95", "bfb04b950ef4b64f", "43345d4165e9e5fb"});
}

// Sheets, not jeans: those are cut with functions (sine, power) whose last bit is the library's or the
// compiler's.
TEST(GoldenBits, OfSheetsWhoseSeamsClose) {
  const System system = stretched_sheets();
  constexpr double dt_s = 1e-4;
  const Hashes expected{"e103187717677f99", "46649101159d128c", "fdb55bbbd3be8fd8"};
  EXPECT_EQ(hash_after_100_steps(*make_serial_dressing(system, semi_euler(), dt_s)), expected.serial);
  for (const std::string_view set : openmp_instruction_sets())
    for (const int threads : {1, 3})
      EXPECT_EQ(hash_after_100_steps(*make_openmp_dressing(
                    system, semi_euler(), dt_s, {.threads = threads, .instruction_set = std::string(set)})),
                fuses(set) ? expected.fused : expected.not_fused)
          << set << ", " << threads << " threads";
}

}  // namespace
}  // namespace mssim
