#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <iterator>
#include <vector>

#include "output/atomic_file.h"
#include "output/h5md_trace.h"
#include "output/write_error.h"
#include "output/xdmf.h"
#include "output_fixture.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Eq;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::uint32_t rows = 4, columns = 5;

Energy energy_at(int frame) { return {1. / 3 * frame, 0.1 * frame, 7. - frame}; }

void write_frame(H5mdTrace& trace, const System& system, int frame) {
  trace.write_frame(10 * frame, 0.1 * frame, state_at(system, frame), energy_at(frame));
}

TraceHeader header() {
  return {"Ada", "1.2.3", R"({"name": "käse"})", R"({"commit": "abc"})", "openmp", "rk4", 1e-3};
}

template <class Value>
std::vector<Value> read(hid_t file, const std::string& path, hid_t type) {
  const Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), "opening " + path);
  const Hdf5Space space(H5Dget_space(dataset.get()), "space");
  std::vector<Value> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
  checked(H5Dread(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "reading " + path);
  return values;
}

std::vector<hsize_t> shape_of(hid_t file, const std::string& path) {
  const Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), "opening " + path);
  const Hdf5Space space(H5Dget_space(dataset.get()), "space");
  std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  return shape;
}

/// All bytes of a string, or an array of strings, in an attribute; checks that their length is fixed.
std::string text_attribute(hid_t file, const std::string& object, const std::string& name) {
  const Hdf5Attribute attribute(H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                                "opening " + name);
  const Hdf5Type type(H5Aget_type(attribute.get()), "type");
  EXPECT_EQ(H5Tis_variable_str(type.get()), 0) << name;
  const Hdf5Space space(H5Aget_space(attribute.get()), "space");
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get()));
  std::string text(count * H5Tget_size(type.get()), '\0');
  checked(H5Aread(attribute.get(), type.get(), text.data()), "reading " + name);
  return text;
}

Hdf5File open(const std::filesystem::path& file) {
  prepare_hdf5();
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "opening " + file.string()};
}

std::vector<float> in_single_precision(const std::vector<Vec3d>& vectors) {
  std::vector<float> numbers;
  for (const Vec3d& vector : vectors)
    for (const double component : {vector.x, vector.y, vector.z})
      numbers.push_back(static_cast<float>(component));
  return numbers;
}

/// Expects a readable trace whose first `frames` frames are those of write_frame().
void expect_frames(const std::filesystem::path& trace, const System& system, int frames) {
  const Hdf5File file = open(trace);
  std::vector<float> position, velocity;
  std::vector<std::int64_t> step;
  std::vector<double> time, kinetic, elastic, gravitational, total;
  for (int frame = 0; frame < frames; ++frame) {
    const State state = state_at(system, frame);
    std::ranges::copy(in_single_precision(state.position), std::back_inserter(position));
    std::ranges::copy(in_single_precision(state.velocity), std::back_inserter(velocity));
    step.push_back(10 * frame);
    time.push_back(0.1 * frame);
    const Energy energy = energy_at(frame);
    kinetic.push_back(energy.kinetic);
    elastic.push_back(energy.elastic);
    gravitational.push_back(energy.gravitational);
    total.push_back(energy.total());
  }
  const auto number = static_cast<hsize_t>(frames);
  EXPECT_EQ(shape_of(file.get(), "/particles/cloth/position/value"),
            (std::vector<hsize_t>{number, system.nodes(), 3}));
  EXPECT_EQ(read<float>(file.get(), "/particles/cloth/position/value", H5T_NATIVE_FLOAT), position);
  EXPECT_EQ(read<float>(file.get(), "/particles/cloth/velocity/value", H5T_NATIVE_FLOAT), velocity);
  EXPECT_EQ(read<std::int64_t>(file.get(), "/particles/cloth/position/step", H5T_NATIVE_INT64), step);
  const auto doubles = [&](const std::string& path) {
    return read<double>(file.get(), path, H5T_NATIVE_DOUBLE);
  };
  EXPECT_EQ(doubles("/particles/cloth/position/time"), time);
  EXPECT_EQ(doubles("/observables/kinetic_energy/value"), kinetic);
  EXPECT_EQ(doubles("/observables/elastic_energy/value"), elastic);
  EXPECT_EQ(doubles("/observables/gravitational_energy/value"), gravitational);
  EXPECT_EQ(doubles("/observables/total_energy/value"), total);
}

class Trace : public OutputTest {
 protected:
  std::filesystem::path file() const { return folder() / "run.h5"; }
  std::filesystem::path part() const { return temporary_of(file()); }
  void write(int frames) const {
    H5mdTrace trace(file(), system_, header());
    for (int frame = 0; frame < frames; ++frame) write_frame(trace, system_, frame);
    trace.close();
  }
  const System system_ = small_cloth(rows, columns);
};

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
  EXPECT_EQ(text_attribute(h5.get(), "/parameters/units", "velocity"), "m s-1");

  std::string scene(header().scene_json.size(), '\0');
  const Hdf5Dataset text(H5Dopen2(h5.get(), "/parameters/scene", H5P_DEFAULT), "scene");
  const Hdf5Type type(H5Dget_type(text.get()), "type");
  ASSERT_EQ(H5Tget_size(type.get()), scene.size());
  H5Dread(text.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, scene.data());
  EXPECT_EQ(scene, header().scene_json);
}

TEST_F(Trace, ListsEachSpringOnceAndTellsWhoseTheyAre) {
  write(0);
  const Hdf5File h5 = open(file());
  const auto ends = read<std::uint32_t>(h5.get(), "/connectivity/springs", H5T_NATIVE_UINT32);
  ASSERT_EQ(ends.size(), 2 * count_springs(rows, columns));
  for (std::size_t s = 0; s < system_.springs.size(); ++s) {
    EXPECT_EQ(ends[2 * s], system_.springs[s].first);
    EXPECT_EQ(ends[2 * s + 1], system_.springs[s].second);
  }
  const Hdf5Attribute group(
      H5Aopen_by_name(h5.get(), "/connectivity/springs", "particles_group", H5P_DEFAULT, H5P_DEFAULT),
      "particles_group");
  hobj_ref_t reference{};
  H5Aread(group.get(), H5T_STD_REF_OBJ, &reference);
  std::array<char, 64> name{};
  H5Rget_name(h5.get(), H5R_OBJECT, &reference, name.data(), name.size());
  EXPECT_STREQ(name.data(), "/particles/cloth");
  EXPECT_EQ(read<double>(h5.get(), "/particles/cloth/mass", H5T_NATIVE_DOUBLE),
            std::vector<double>(system_.nodes(), system_.node_mass));
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
  const std::string xdmf = text_of(folder() / "run.xdmf");
  const auto renamed = folder() / "renamed.h5";
  std::filesystem::rename(file(), renamed);
  const Hdf5File h5 = open(renamed);
  for (int frame = 0; frame < 3; ++frame) {
    const State state = state_at(system_, frame);
    for (const auto& [vector, values] :
         {std::pair{"position", state.position}, std::pair{"velocity", state.velocity}}) {
      const std::string path = xdmf_dataset(vector, static_cast<std::size_t>(frame));
      EXPECT_EQ(shape_of(h5.get(), path), (std::vector<hsize_t>{1, rows, columns, 3}));
      EXPECT_EQ(read<float>(h5.get(), path, H5T_NATIVE_FLOAT), in_single_precision(values)) << path;
      EXPECT_THAT(xdmf, HasSubstr(">run.h5:" + path + "<"));
    }
  }
  EXPECT_THAT(xdmf, AllOf(HasSubstr("<Time Value=\"0.2\"/>"), HasSubstr("Dimensions=\"1 4 5\""),
                          Not(HasSubstr("000003"))));
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
int write_in_little_room(const std::filesystem::path& file, const System& system, const std::string& reason) {
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
  EXPECT_THAT(message, AllOf(HasSubstr("cannot write " + file.string()), HasSubstr(reason)));
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
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      return write_in_little_room(folder() / std::to_string(bytes), system_, "File too large");
    });
    EXPECT_THAT(outcome, AnyOf(Eq(last), Eq(complete))) << "with " << bytes << " bytes";
    last = outcome == complete ? complete : last;
  }
  EXPECT_EQ(last, complete) << "the largest limit should be no limit";
}

TEST_F(Trace, KeepsAllFramesOnAFullDisk) {
  constexpr int no_mounts_here = 77;
  for (const char* size : {"size=16k", "size=100k", "size=120k", "size=140k", "size=4m"}) {
    const int outcome = exit_of_child([&] {
      if (::unshare(::geteuid() == 0 ? CLONE_NEWNS : CLONE_NEWNS | CLONE_NEWUSER) != 0) return no_mounts_here;
      if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
          ::mount("tmpfs", folder().c_str(), "tmpfs", 0, size) != 0)
        return no_mounts_here;
      return write_in_little_room(file(), system_, "No space left on device");
    });
    if (outcome == no_mounts_here) GTEST_SKIP() << "this system lets the test mount no small disk";
    EXPECT_EQ(outcome, std::string(size) == "size=4m" ? complete : failed_properly) << size;
  }
}

TEST_F(Trace, CannotBeginInAFolderThatIsMissingOrMayNotBeWritten) {
  const auto begin = [&](const std::filesystem::path& path) { H5mdTrace(path, system_, header()); };
  EXPECT_THAT([&] { begin(folder() / "missing" / "run.h5"); },
              ThrowsMessage<WriteError>(
                  AllOf(HasSubstr("No such file or directory"), HasSubstr("create its folder"))));
  std::filesystem::create_directory(file());
  EXPECT_THAT([&] { begin(file()); }, ThrowsMessage<WriteError>(HasSubstr("is a folder")));
  EXPECT_EQ(exit_of_child([&] {
              std::filesystem::permissions(folder(), std::filesystem::perms{0555});
              constexpr uid_t nobody = 65534;
              if (::geteuid() == 0 && ::seteuid(nobody) != 0) return 2;
              EXPECT_THAT([&] { begin(folder() / "other.h5"); },
                          ThrowsMessage<WriteError>(AllOf(HasSubstr("Permission denied"),
                                                          HasSubstr("a folder that you may write to"))));
              return testing::Test::HasFailure() ? 1 : 0;
            }),
            0);
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

}  // namespace
}  // namespace mssim
