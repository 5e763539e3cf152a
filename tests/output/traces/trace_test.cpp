#include <sys/resource.h>

#include <csignal>

#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "tests/support/trace_fixture.h"

namespace mssim {
namespace {

using testing::AnyOf;
using testing::Eq;
using testing::ThrowsMessage;

/// The particles that a dataset is about.
std::string group_of(hid_t file, const std::string& dataset) {
  const Hdf5Attribute group(
      H5Aopen_by_name(file, dataset.c_str(), "particles_group", H5P_DEFAULT, H5P_DEFAULT), "particles_group");
  hobj_ref_t reference{};
  H5Aread(group.get(), H5T_STD_REF_OBJ, &reference);
  std::array<char, 64> name{};
  H5Rget_name(file, H5R_OBJECT, &reference, name.data(), name.size());
  return name.data();
}

TEST_F(Trace, GivesBackWhatWasWritten) {
  constexpr int more_than_a_chunk_of_numbers = 300;
  write(more_than_a_chunk_of_numbers);
  expect_frames(file(), system_, more_than_a_chunk_of_numbers);
  EXPECT_FALSE(std::filesystem::exists(part()));
}

TEST_F(Trace, SaysWhatItIsAndHowItCameAbout) {
  write(1);
  const Hdf5File h5 = open(file());
  const Hdf5Attribute version(H5Aopen_by_name(h5.get(), "/h5md", "version", H5P_DEFAULT, H5P_DEFAULT),
                              "version");
  std::array<int, 2> numbers{};
  H5Aread(version.get(), H5T_NATIVE_INT, numbers.data());
  EXPECT_EQ(numbers, (std::array<int, 2>{1, 1}));
  EXPECT_EQ(text_attribute(h5.get(), "/h5md/author", "name"), "Ada");
  EXPECT_EQ(text_attribute(h5.get(), "/h5md/creator", "name"), "mssim");
  EXPECT_EQ(text_attribute(h5.get(), "/h5md/creator", "version"), "1.2.3");
  EXPECT_EQ(text_attribute(h5.get(), "/particles/cloth/box", "boundary"), "nonenonenone");
  EXPECT_EQ(text_attribute(h5.get(), "/parameters", "backend"), "openmp");
  EXPECT_EQ(text_attribute(h5.get(), "/parameters", "integrator"), "rk4");
  for (const auto& [quantity, unit] : {std::pair{"position", "m"},
                                       {"velocity", "m s-1"},
                                       {"time", "s"},
                                       {"mass", "kg"},
                                       {"energy", "J"},
                                       {"rest_length", "m"},
                                       {"stiffness", "N m-1"},
                                       {"damping", "N s m-1"}})
    EXPECT_EQ(text_attribute(h5.get(), "/parameters/units", quantity), unit) << quantity;
  EXPECT_EQ(text_in(h5.get(), "/parameters/scene"), header().scene_json);
}

TEST_F(Trace, ListsEachSpringOnceAndTellsWhoseTheyAre) {
  write(0);
  const Hdf5File h5 = open(file());
  const auto ends = read<std::uint32_t>(h5.get(), "/connectivity/springs", H5T_NATIVE_UINT32);
  ASSERT_EQ(ends.size(), 2 * count_springs(cloth_rows, cloth_columns));
  for (std::size_t s = 0; s < system_.springs.size(); ++s) {
    EXPECT_EQ(ends[2 * s], system_.springs[s].first);
    EXPECT_EQ(ends[2 * s + 1], system_.springs[s].second);
  }
  EXPECT_EQ(group_of(h5.get(), "/connectivity/springs"), "/particles/cloth");
  EXPECT_EQ(read<double>(h5.get(), "/particles/cloth/mass", H5T_NATIVE_DOUBLE), system_.node_mass);
}

TEST_F(Trace, TellsWhoseTetrahedraAre) {
  H5mdTrace trace(file(), two_solid_blocks(), header());
  trace.close();
  EXPECT_EQ(group_of(open(file()).get(), "/connectivity/tetrahedra"), "/particles/bodies");
}

TEST_F(Trace, SharesStepAndTimeByHardLinks) {
  write(2);
  const Hdf5File h5 = open(file());
  const auto address = [&](const std::string& path) {
    H5O_info_t info{};
    checked(H5Oget_info_by_name(h5.get(), path.c_str(), &info, H5P_DEFAULT), path);
    return info.addr;
  };
  for (const std::string name : {"/step", "/time"})
    for (const std::string element :
         {"/particles/cloth/velocity", "/observables/kinetic_energy", "/observables/elastic_energy",
          "/observables/gravitational_energy", "/observables/total_energy"})
      EXPECT_EQ(address(element + name), address("/particles/cloth/position" + name)) << element << name;
}

// MDAnalysis refuses units that it does not know, and H5MD's thermodynamics module means energies per
// particle.
TEST_F(Trace, HasNoUnitAttributesAndNoModules) {
  write(1);
  const Hdf5File h5 = open(file());
  for (const char* path : {"/particles/cloth/position/value", "/particles/cloth/velocity/value",
                           "/particles/cloth/position/time"})
    EXPECT_EQ(H5Aexists_by_name(h5.get(), path, "unit", H5P_DEFAULT), 0) << path;
  EXPECT_EQ(H5Lexists(h5.get(), "/h5md/modules", H5P_DEFAULT), 0);
}

TEST_F(Trace, ShowsEveryFrameToXdmfReadersEvenAfterItIsRenamed) {
  write(3);
  const std::string xdmf = read_file(folder() / "run.xdmf");
  const auto renamed = folder() / "renamed.h5";
  std::filesystem::rename(file(), renamed);
  const Hdf5File h5 = open(renamed);
  for (int frame = 0; frame < 3; ++frame) {
    const State state = state_at(system_, frame);
    for (const auto& [vector, values] :
         {std::pair{"position", state.position}, std::pair{"velocity", state.velocity}}) {
      const std::string path =
          xdmf_dataset(vector, xdmf_mesh_of(shape_of(system_.topology), system_.nodes(), {}).parts.front(),
                       static_cast<std::size_t>(frame));
      EXPECT_EQ(shape_of(h5.get(), path), (std::vector<hsize_t>{1, cloth_rows, cloth_columns, 3}));
      EXPECT_EQ(read<float>(h5.get(), path, H5T_NATIVE_FLOAT), in_single_precision(values)) << path;
      EXPECT_THAT(xdmf, HasSubstr(">run.h5:" + path + "<"));
    }
  }
  EXPECT_THAT(xdmf, AllOf(HasSubstr("<Time Value=\"0.2\"/>"), HasSubstr("Dimensions=\"1 4 5\""),
                          Not(HasSubstr("000003"))));
}

TEST_F(Trace, IsFoundByXdmfReadersUnderANameBeyondAscii) {
  for (const std::string name : {"Übung.h5", "日本.h5", "été & co.h5"}) {
    H5mdTrace trace(folder() / name, system_, header());
    write_frame(trace, system_, 0);
    trace.close();
    // VTK 9 drops bytes beyond ASCII at the begin.
    EXPECT_THAT(read_file(xdmf_of(folder() / name)), HasSubstr(">./" + name.substr(0, 2)));
  }
}

TEST_F(Trace, RefusesStatesOfAnotherSizeAndStepsThatDoNotIncrease) {
  H5mdTrace trace(file(), system_, header());
  write_frame(trace, system_, 1);
  EXPECT_THROW(write_frame(trace, system_, 1), std::invalid_argument);
  EXPECT_THROW(trace.write_frame(20, 0.2, State{}, {}), std::invalid_argument);
  write_frame(trace, system_, 2);
  trace.close();
}

TEST_F(Trace, IsAsSmallAsItsNumbersAllow) {
  const System large = small_cloth(50, 50);
  H5mdTrace trace(file(), large, header());
  State level = large.start;  // level and at rest: there is nothing to store
  trace.write_frame(0, 0, level, {});
  trace.close();
  const Hdf5File h5 = open(file());
  const Hdf5Dataset position(H5Dopen2(h5.get(), "/particles/cloth/position/value", H5P_DEFAULT), "position");
  EXPECT_LT(H5Dget_storage_size(position.get()), 1000U);
  const Hdf5Properties properties(H5Dget_create_plist(position.get()), "properties");
  std::array<hsize_t, 3> chunk{};
  H5Pget_chunk(properties.get(), 3, chunk.data());
  EXPECT_EQ(chunk, (std::array<hsize_t, 3>{1, 2500, 3}));
  EXPECT_EQ(H5Pget_nfilters(properties.get()), 3);
}

TEST_F(Trace, KeepsAllFramesWhenTheProcessIsKilled) {
  const int status = status_in_child([&] {
    H5mdTrace trace(file(), system_, header());
    for (int frame = 0; frame < 70; ++frame) write_frame(trace, system_, frame);
    return std::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  expect_frames(part(), system_, 70);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

enum Outcome { complete = 10, failed_properly, wrong };

/// Writes a trace of 20 frames where there may be too little room for it.
int write_in_little_room(const std::filesystem::path& file, const System& system) {
  std::string message;
  int frame = 0;
  try {
    H5mdTrace trace(file, system, header());
    for (; frame < 20; ++frame) write_frame(trace, system, frame);
    trace.close();
  } catch (const WriteError& error) {
    message = error.what();
  }
  const auto part = temporary_of(file);
  if (message.empty()) {
    expect_frames(file, system, 20);
    EXPECT_FALSE(std::filesystem::exists(part));
    return testing::Test::HasFailure() ? wrong : complete;
  }
  EXPECT_THAT(message, AllOf(HasSubstr("cannot write " + file.string()), HasSubstr("File too large")));
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(std::filesystem::exists(part), frame > 0);
  if (frame > 0) {
    EXPECT_THAT(message, HasSubstr("keeps the frames written before: " + std::to_string(frame)));
    expect_frames(part, system, frame);
  }
  return testing::Test::HasFailure() ? wrong : failed_properly;
}

TEST_F(Trace, KeepsAllFramesWhereverTheLimitOnFileSizesStrikes) {
  Outcome last = failed_properly;
  for (rlim_t bytes = 1000; bytes < 240000; bytes += 7000) {
    const int outcome = exit_of_child([&] {
      limit_file_size(bytes);
      return write_in_little_room(folder() / std::to_string(bytes), system_);
    });
    EXPECT_THAT(outcome, AnyOf(Eq(last), Eq(complete))) << "with " << bytes << " bytes";
    last = outcome == complete ? complete : last;
  }
  EXPECT_EQ(last, complete) << "the largest limit should be no limit";
}

TEST_F(Trace, CannotBeginInAFolderThatIsMissingOrMayNotBeWritten) {
  const auto begin = [&](const std::filesystem::path& path) { H5mdTrace(path, system_, header()); };
  EXPECT_THAT([&] { begin(folder() / "missing" / "run.h5"); },
              ThrowsMessage<WriteError>(
                  AllOf(HasSubstr("No such file or directory"), HasSubstr("create its folder"))));
  std::filesystem::create_directory(file());
  EXPECT_THAT([&] { begin(file()); }, ThrowsMessage<WriteError>(HasSubstr("is a folder")));
  expect_in_child([&] {
    std::filesystem::permissions(folder(), std::filesystem::perms{0555});
    ASSERT_TRUE(become_nobody());
    EXPECT_THAT([&] { begin(folder() / "other.h5"); },
                ThrowsMessage<WriteError>(
                    AllOf(HasSubstr("Permission denied"), HasSubstr("a folder that you may write to"))));
  });
}

TEST_F(Trace, LeavesATemporaryFileOnlyWhenItIsGivenUpWithFrames) {
  { const H5mdTrace trace(file(), system_, header()); }
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
  {
    H5mdTrace trace(file(), system_, header());
    write_frame(trace, system_, 0);
  }
  EXPECT_FALSE(std::filesystem::exists(file()));
  expect_frames(part(), system_, 1);
}

TEST_F(Trace, RefusesANameThatItsXdmfWouldTake) {
  EXPECT_THAT([&] { H5mdTrace(folder() / "run.xdmf", system_, header()); },
              ThrowsMessage<WriteError>(HasSubstr("choose a name that ends in .h5")));
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

std::string name_problem(const std::string& name) { return trace_name_problem(name).value_or("none"); }

TEST(TraceName, IsGoodWhereItEndsInH5AndIsPrintable) {
  for (const std::string name :
       {"t.h5", "out/fall.h5", "/a:b/t.h5", "the 'trace' & more.h5", "t.x.h5", "\xC3\xA4.h5"})
    EXPECT_EQ(name_problem(name), "none") << name;
}

TEST(TraceName, EndsInH5) {
  EXPECT_EQ(name_problem("out/t.txt"), "\"t.txt\" is not a name of the form NAME.h5: give t.h5");
  EXPECT_EQ(name_problem("t"), "\"t\" is not a name of the form NAME.h5: give t.h5");
  EXPECT_EQ(name_problem(".h5"), "\".h5\" is not a name of the form NAME.h5: give .h5.h5");
  EXPECT_EQ(name_problem("out/"), "\"\" is not a name of the form NAME.h5: give a file in that folder");
}

TEST(TraceName, HasNothingThatReadersOfTheXdmfFileMisread) {
  for (const std::string name : {"a:b.h5", "a|b.h5", "a\\b.h5"})
    EXPECT_THAT(name_problem(name), HasSubstr("readers of the XDMF file misread: give a name without"));
  for (const std::string name : {"a\nb.h5", "a\x1b.h5", "caf\xe9.h5"})
    EXPECT_THAT(name_problem(name), HasSubstr("has characters that are not printable"));
  for (const std::string name : {" t.h5", "t .h5"})
    EXPECT_THAT(name_problem(name), HasSubstr("begins or ends with a blank"));
}

TEST_F(Trace, RefusesTetrahedraThatAreMissingOrPointBeyondTheNodes) {
  System system = two_solid_blocks();
  std::get<TetrahedralMesh>(system.topology).tetrahedra.back()[2] =
      static_cast<std::uint32_t>(system.nodes());
  EXPECT_THROW(H5mdTrace(file(), system, header()), std::invalid_argument);
  system.topology = TetrahedralMesh{};
  EXPECT_THROW(H5mdTrace(file(), system, header()), std::invalid_argument);
  system.topology = GridPatch{3, 5, 0.01};
  EXPECT_THROW(H5mdTrace(file(), system, header()), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

TEST_F(Trace, RefusesFramesWithLossesWhereItsHeaderHasNoneAndTheOtherWayRound) {
  H5mdTrace without(file(), system_, header());
  EXPECT_THROW(without.write_frame(0, 0, state_at(system_, 0), {}, EnergyLosses{}), std::invalid_argument);
  TraceHeader with_losses = header();
  with_losses.with_losses = true;
  H5mdTrace with(folder() / "other.h5", system_, with_losses);
  EXPECT_THROW(with.write_frame(0, 0, state_at(system_, 0), {}), std::invalid_argument);
  without.close();
  const Hdf5File h5 = open(file());
  EXPECT_EQ(H5Lexists(h5.get(), "/observables/damping_loss", H5P_DEFAULT), 0);
}

}  // namespace
}  // namespace mssim
