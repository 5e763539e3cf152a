#include "bench/verification/reference_cache.h"

#include <chrono>

#include "integrators/all_integrators.h"
#include "platform/files.h"
#include "tests/support/files_fixture.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr double dt_s = 1e-4;

class ReferenceCacheTest : public TemporaryFolderTest {
 protected:
  Reference recall(const System& system, bool anew = false) const {
    return recall_reference(cache_, system, *find_integrator("semi-euler"), dt_s, anew);
  }
  std::vector<fs::path> entries() const {
    std::vector<fs::path> files;
    for (const fs::directory_entry& file : fs::directory_iterator(cache_.folder))
      files.push_back(file.path());
    return files;
  }

  ReferenceCache cache_{
      .folder = folder() / "made" / "references", .program_fnv1a_64 = 1, .least_seconds = 0};
  const System cloth_ = cloth_system(9, 11);
};

void expect_same(const Reference& a, const Reference& b) {
  EXPECT_EQ(state_hash(a.state), state_hash(b.state));
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.energy.total(), b.energy.total());
  EXPECT_EQ(a.tolerance, b.tolerance);
  EXPECT_EQ(a.failure, b.failure);
}

TEST_F(ReferenceCacheTest, RecallsWhatItHasFoundToTheLastBit) {
  for (const System& system : {cloth_, solid_block(3, 4, 5)}) {
    const Reference first = recall(system), second = recall(system);
    EXPECT_FALSE(first.recalled);
    EXPECT_TRUE(second.recalled);
    EXPECT_EQ(first.step_seconds, second.step_seconds);
    expect_same(first, second);
    expect_same(first, run_reference(system, *find_integrator("semi-euler"), dt_s));
    EXPECT_FALSE(recall(system, true).recalled);
  }
  EXPECT_EQ(entries().size(), 2U);
}

TEST_F(ReferenceCacheTest, RecallsNothingOfAnotherSystemMethodStepOrProgram) {
  recall(cloth_);
  const std::vector<std::function<void(System&)>> changes{
      [](System& s) { s.springs[7].rest_length *= 1.001F; },
      [](System& s) { s.springs[7].kind = (s.springs[7].kind + 1) % 3; },
      [](System& s) { std::swap(s.springs[7], s.springs[8]); },
      [](System& s) { s.materials[1].stiffness *= 1.001; },
      [](System& s) { s.materials[1].damping *= 1.001; },
      [](System& s) { s.pins.pop_back(); },
      [](System& s) { s.node_mass[5] *= 1.001; },
      [](System& s) { s.gravity *= 1.001; },
      [](System& s) { s.viscous_damping += 0.001; },
      [](System& s) { s.floor.height -= 0.125; },
      [](System& s) { s.floor.restitution += 0.001; },
      [](System& s) { s.floor.friction += 0.001; },
      [](System& s) { s.solver.tolerance *= 0.5; },
      [](System& s) { ++s.solver.iterations; },
      [](System& s) { ++s.solver.substeps; },
      [](System& s) { s.start.position[50].x += 0x1p-20; },
      [](System& s) { s.start.velocity[50].x += 0x1p-20; },
      [](System& s) { std::get<GridPatch>(s.topology).spacing *= 2; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    System other = cloth_;
    changes[i](other);
    EXPECT_FALSE(recall(other).recalled) << i;
  }
  EXPECT_FALSE(recall_reference(cache_, cloth_, *find_integrator("rk4"), dt_s).recalled);
  EXPECT_FALSE(recall_reference(cache_, cloth_, *find_integrator("semi-euler"), dt_s / 2).recalled);
  EXPECT_TRUE(recall(cloth_).recalled);
  cache_.program_fnv1a_64 = 2;
  EXPECT_FALSE(recall(cloth_).recalled);
}

TEST_F(ReferenceCacheTest, ReplacesWhatIsDamaged) {
  const Reference right = recall(cloth_);
  const fs::path file = entries().front();
  const std::string whole = read_file(file);
  std::vector<std::string> damaged{"", whole.substr(0, whole.size() - 1), whole + 'x'};
  for (std::size_t at = 0; at < whole.size(); at += 97) (damaged.emplace_back(whole))[at] ^= 1;
  damaged.emplace_back(whole).back() ^= 1;
  for (const std::string& text : damaged) {
    write_file_atomically(file, text);
    const Reference found = recall(cloth_);
    EXPECT_FALSE(found.recalled);
    expect_same(found, right);
    EXPECT_TRUE(recall(cloth_).recalled);
  }
}

TEST_F(ReferenceCacheTest, ForgetsWhatWasNotUsedForLongest) {
  std::vector<System> cloths(5, cloth_);
  for (std::size_t i = 0; i < cloths.size(); ++i) cloths[i].gravity += static_cast<double>(i);
  recall(cloths[0]);
  cache_.most_bytes = 4 * fs::file_size(entries().front());
  for (std::size_t i = 0; i < 4; ++i) {
    recall(cloths[i]);
    for (const fs::path& file : entries())
      fs::last_write_time(file, fs::last_write_time(file) - std::chrono::hours(1));
  }
  EXPECT_TRUE(recall(cloths[0]).recalled);
  EXPECT_FALSE(recall(cloths[4]).recalled);
  EXPECT_EQ(entries().size(), 4U);
  EXPECT_TRUE(recall(cloths[0]).recalled);
  EXPECT_FALSE(recall(cloths[1]).recalled);
}

TEST_F(ReferenceCacheTest, DoesWithoutWhatCannotBeWrittenOrIsNotWorthIt) {
  const Reference right = run_reference(cloth_, *find_integrator("semi-euler"), dt_s);
  const auto expect_not_kept = [&] {
    expect_same(recall(cloth_), right);
    EXPECT_FALSE(recall(cloth_).recalled);
  };
  const ReferenceCache usual = cache_;
  cache_.folder = put("file", "") / "references";
  expect_not_kept();
  cache_.folder.clear();
  expect_not_kept();
  cache_ = usual;
  cache_.least_seconds = 3600;
  expect_not_kept();
  cache_ = usual;
  cache_.most_bytes = 4 * 48 * 99 - 1;
  expect_not_kept();
  EXPECT_FALSE(fs::exists(usual.folder));
}

}  // namespace
}  // namespace mssim
