// Traces that are damaged, or say what cannot be: one sentence each, and never a crash.
#include <zlib.h>

#include "hdf5/hdf5.h"
#include "output/traces/trace_reader.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "tests/support/trace_fixture.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

/// Reads all of a trace. What is wrong with it, or nothing.
std::string problem_of(const std::filesystem::path& trace) {
  try {
    const TraceReader reader(trace);
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) {
      reader.positions(frame);
      reader.velocities(frame);
    }
  } catch (const TraceError& error) {
    EXPECT_EQ(error.exit_code, exit_bad_input) << error.what();
    return error.what();
  }
  return "";
}

class TraceDamage : public Trace {
 protected:
  /// The problem of the trace of a system after a change to its file.
  template <class Change>
  std::string after(const System& system, const Change& change, const Surface& body = {}) const {
    write(system, 3, body);
    {
      const Hdf5File h5 = open(file(), H5F_ACC_RDWR);
      change(h5.get());
      checked(H5Fflush(h5.get(), H5F_SCOPE_GLOBAL), "flushing");
    }
    return problem_of(file());
  }
  template <class Number>
  static void set_numbers(hid_t h5, const std::string& path, hid_t type, std::vector<Number> numbers) {
    const Hdf5Dataset dataset(H5Dopen2(h5, path.c_str(), H5P_DEFAULT), path);
    checked(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), path);
  }
  template <class Number>
  static void set_first(hid_t h5, const std::string& path, hid_t type, Number number) {
    std::vector<Number> numbers = read<Number>(h5, path, type);
    numbers.front() = number;
    set_numbers(h5, path, type, numbers);
  }
  static void remove(hid_t h5, const std::string& path) {
    checked(H5Ldelete(h5, path.c_str(), H5P_DEFAULT), path);
  }
  static void replace(hid_t h5, const std::string& path, hid_t type, const std::vector<hsize_t>& shape) {
    remove(h5, path);
    const std::vector<char> zeros(100000, 0);
    write_array(h5, path, type, type, shape, zeros.data());
  }
};

TEST_F(TraceDamage, IsSaidOfFilesThatEndEarly) {
  write(two_panels(), 3, small_tetrahedron());
  const std::string bytes = read_file(file());
  constexpr std::size_t step = 997;
  for (std::size_t length = 0; length < bytes.size(); length += step) {
    const std::string problem = problem_of(put("short.h5", std::string_view(bytes).substr(0, length)));
    EXPECT_THAT(problem, HasSubstr("short.h5: ")) << length;
  }
}

TEST_F(TraceDamage, OfAnyByteGivesASentenceOrNothingElseThanWasWritten) {
  for (const System& system : {system_, solid_block(2, 2, 2), two_panels()}) {
    write(system, 3);
    const std::string bytes = read_file(file());
    std::mt19937 random(1);
    for (int trial = 0; trial < 60; ++trial) {
      std::string damaged = bytes;
      for (int flip = 0; flip < 20; ++flip) damaged[random() % bytes.size()] = static_cast<char>(random());
      const auto trace = put("damaged.h5", damaged);
      if (const std::string problem = problem_of(trace); !problem.empty()) {
        EXPECT_THAT(problem, HasSubstr("damaged.h5: "));
        continue;
      }
      const TraceReader reader(trace);
      for (int frame = 0; frame < 3; ++frame) {
        State state = state_at(system, frame);
        round_to_single(state);
        EXPECT_EQ(reader.positions(static_cast<std::size_t>(frame)), state.position) << trial;
      }
    }
  }
}

TEST_F(TraceDamage, OfAChecksumIsSaid) {
  write(3);
  std::string bytes = read_file(file());
  haddr_t address = 0;
  {
    const Hdf5File h5 = open(file());
    const Hdf5Dataset position(H5Dopen2(h5.get(), "/particles/cloth/position/value", H5P_DEFAULT),
                               "position");
    const std::array<hsize_t, 3> second{1, 0, 0};
    unsigned filters = 0;
    hsize_t size = 0;
    checked(H5Dget_chunk_info_by_coord(position.get(), second.data(), &filters, &address, &size), "chunk");
  }
  bytes[address + 20] = static_cast<char>(bytes[address + 20] + 1);
  const auto trace = put("flipped.h5", bytes);
  const TraceReader reader(trace);
  EXPECT_EQ(reader.positions(0).size(), system_.nodes());
  EXPECT_THROW(reader.positions(1), TraceError);
  // HDF5 1.14 does not say which filter it was.
  EXPECT_THAT(problem_of(trace),
              testing::AnyOf(HasSubstr("Fletcher32"), HasSubstr("filter returned failure")));
}

TEST_F(TraceDamage, OfTheLengthThatAPartInflatesToIsSaid) {
  const std::string path = "/particles/cloth/position/value";
  const auto with = [&](std::size_t bytes) {
    return after(system_, [&](hid_t h5) {
      remove(h5, path);
      const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), "properties");
      const std::array<hsize_t, 3> shape{3, 20, 3}, chunk{3, 20, 2}, second{0, 0, 2};
      checked(H5Pset_chunk(properties.get(), 3, chunk.data()), "chunks");
      checked(H5Pset_deflate(properties.get(), 1), "deflation");
      const Hdf5Dataset dataset = create_dataset(h5, path, H5T_IEEE_F32LE, shape, properties);
      const std::array<float, 180> zeros{};
      checked(H5Dwrite(dataset.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), path);
      const std::vector<Bytef> text(bytes, 0);
      uLongf length = ::compressBound(text.size());
      std::vector<Bytef> packed(length);
      ASSERT_EQ(::compress(packed.data(), &length, text.data(), text.size()), Z_OK);
      checked(H5Dwrite_chunk(dataset.get(), H5P_DEFAULT, 0, second.data(), length, packed.data()), path);
    });
  };
  constexpr std::size_t right = 3 * 20 * 2 * sizeof(float);
  EXPECT_EQ(with(right), "");
  for (const std::size_t wrong : {std::size_t{0}, right - 1, right + 1, 3 * right, std::size_t{1} << 20})
    EXPECT_THAT(with(wrong), HasSubstr("a chunk of the wrong length")) << wrong;
}

TEST_F(TraceDamage, IsSaidOfDatasetsThatAreMissing) {
  for (const std::string path :
       {"/h5md", "/particles", "/particles/cloth", "/particles/cloth/position",
        "/particles/cloth/position/step", "/particles/cloth/position/time", "/particles/cloth/position/value",
        "/particles/cloth/velocity/value", "/parameters", "/parameters/scene"})
    EXPECT_THAT(after(system_, [&](hid_t h5) { remove(h5, path); }), HasSubstr("run.h5: ")) << path;
  for (const std::string name : {"rows", "columns"})
    EXPECT_THAT(
        after(system_, [&](hid_t h5) { H5Adelete_by_name(h5, "/parameters", name.c_str(), H5P_DEFAULT); }),
        HasSubstr("/parameters has no attribute " + name));
  EXPECT_THAT(after(solid_block(2, 2, 2), [](hid_t h5) { remove(h5, "/connectivity/tetrahedra"); }),
              HasSubstr("a trace of bodies needs tetrahedra"));
  for (const std::string path :
       {"/parameters/panels/name", "/parameters/panels/rows", "/parameters/panels/first_node"})
    EXPECT_THAT(after(two_panels(), [&](hid_t h5) { remove(h5, path); }), HasSubstr("there is no " + path));
}

TEST_F(TraceDamage, IsSaidOfOtherTypesAndExtents) {
  const auto other = [&](const std::string& path, hid_t type, const std::vector<hsize_t>& shape) {
    return after(system_, [&](hid_t h5) { replace(h5, path, type, shape); });
  };
  const std::string position = "/particles/cloth/position/value", springs = "/connectivity/springs",
                    rest_length = "/parameters/springs/rest_length";
  const hsize_t count = system_.springs.size();
  EXPECT_THAT(other(position, H5T_STD_I32LE, {3, 20, 3}), HasSubstr("numbers of a type that"));
  EXPECT_EQ(other(position, H5T_IEEE_F32BE, {3, 20, 3}), "");
  EXPECT_THAT(other(position, H5T_IEEE_F32LE, {3, 19, 3}),
              HasSubstr("has the extents 3 x 20 x 3 instead of"));
  EXPECT_THAT(other(position, H5T_IEEE_F32LE, {3, 20, 2}),
              HasSubstr("has the extents 3 x 20 x 2 instead of"));
  EXPECT_THAT(other(position, H5T_IEEE_F32LE, {60, 3}), HasSubstr("has the extents 60 x 3 instead of"));
  EXPECT_THAT(other(position, H5T_IEEE_F32LE, {1, 20, 3}), HasSubstr("different numbers of frames, 1 to 3"));
  EXPECT_THAT(other(springs, H5T_STD_U32LE, {count, 3}), HasSubstr("instead of any x 2"));
  EXPECT_THAT(other(springs, H5T_IEEE_F64LE, {count, 2}), HasSubstr("numbers of a type that"));
  EXPECT_THAT(other(springs, H5T_STD_U32LE, {count, 2}),
              HasSubstr("a spring between the nodes 0 and 0 of 20"));
  EXPECT_THAT(other(rest_length, H5T_IEEE_F64LE, {count - 1}),
              HasSubstr("instead of " + std::to_string(count)));
  EXPECT_THAT(other(rest_length, H5T_IEEE_F64LE, {count}), HasSubstr("a length that is not above 0"));
  EXPECT_THAT(other("/parameters/scene", H5T_IEEE_F64LE, {4}), HasSubstr("/parameters/scene is not text"));
}

TEST_F(TraceDamage, IsSaidOfIndicesThatAreOutOfRange) {
  const System garment = two_panels(), block = solid_block(2, 2, 2);
  const auto with = [&](const System& system, const std::string& path, std::uint32_t number) {
    return after(
        system, [&](hid_t h5) { set_first(h5, path, H5T_NATIVE_UINT32, number); },
        std::holds_alternative<Garment>(system.topology) ? small_tetrahedron() : Surface{});
  };
  EXPECT_THAT(with(system_, "/connectivity/springs", 20), HasSubstr("spring between the nodes 20 and"));
  EXPECT_THAT(with(block, "/connectivity/tetrahedra", 8), HasSubstr("tetrahedra between its nodes"));
  EXPECT_THAT(with(garment, "/body/triangles", 4), HasSubstr("triangles between its points"));
  EXPECT_THAT(with(garment, "/parameters/panels/first_node", 1),
              HasSubstr("panels of rows and columns, in order"));
  for (const std::string path : {"/parameters/panels/rows", "/parameters/panels/columns"})
    for (const std::uint32_t number : {0U, 1U, 5U, 0x40000000U, 0xffffffffU})
      EXPECT_THAT(with(garment, path, number), HasSubstr("needs panels of")) << number;
  EXPECT_THAT(after(system_,
                    [](hid_t h5) {
                      H5Adelete_by_name(h5, "/parameters", "rows", H5P_DEFAULT);
                      H5Adelete_by_name(h5, "/parameters", "columns", H5P_DEFAULT);
                      const Hdf5Group group(H5Gopen2(h5, "/parameters", H5P_DEFAULT), "parameters");
                      write_attribute(group.get(), "rows", (std::int64_t{1} << 30) + 5);  // 20 modulo 2^32
                      write_attribute(group.get(), "columns", std::int64_t{4});
                    }),
              HasSubstr("a grid of all nodes"));
}

TEST_F(TraceDamage, IsSaidOfNumbersThatAreNotFiniteAndTimesThatDoNotIncrease) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [&](const std::string& path, double number) {
    return after(system_, [&](hid_t h5) { set_first(h5, path, H5T_NATIVE_DOUBLE, number); });
  };
  EXPECT_THAT(with("/particles/cloth/position/value", nan),
              HasSubstr("the position of node 0 in frame 0 is not"));
  EXPECT_THAT(with("/particles/cloth/velocity/value", INFINITY),
              HasSubstr("the velocity of node 0 in frame 0"));
  EXPECT_THAT(with("/parameters/springs/rest_length", nan), HasSubstr("a length that is not above 0"));
  for (const double time_s : {0.1, 7., nan, double{-INFINITY}})
    EXPECT_THAT(with("/particles/cloth/position/time", time_s),
                HasSubstr("its steps and times do not increase"));
}

TEST_F(TraceDamage, IsSaidOfVelocitiesAtOtherTimesThanPositions) {
  const std::string velocity = "/particles/cloth/velocity";
  const auto with = [&](const std::string& name, hid_t type, const auto& numbers) {
    return after(system_, [&](hid_t h5) {
      remove(h5, velocity + name);
      write_array(h5, velocity + name, type, type, std::array<hsize_t, 1>{numbers.size()}, numbers.data());
    });
  };
  using Steps = std::vector<std::int64_t>;
  using Times = std::vector<double>;
  EXPECT_EQ(with("/step", H5T_NATIVE_INT64, Steps{0, 10, 20, 30}), "");
  EXPECT_EQ(with("/time", H5T_NATIVE_DOUBLE, Times{0, 0.1, 0.1 * 2}), "");
  EXPECT_THAT(with("/step", H5T_NATIVE_INT64, Steps{0, 5, 10}),
              HasSubstr(velocity + " have different steps"));
  EXPECT_THAT(with("/time", H5T_NATIVE_DOUBLE, Times{0, 0.05, 0.1}), HasSubstr(velocity + " have different"));
  EXPECT_THAT(with("/step", H5T_NATIVE_INT64, Steps{0, 10}), HasSubstr(velocity + "/step has too few rows"));
  EXPECT_EQ(after(system_,
                  [&](hid_t h5) {
                    remove(h5, velocity + "/step");
                    remove(h5, velocity + "/time");
                  }),
            "");
}

TEST_F(TraceDamage, IsSaidOfWhatLiesElsewhere) {
  put("secret.bin", std::string(100000, 'x'));
  const std::string scene = "/parameters/scene";
  EXPECT_THAT(after(system_,
                    [&](hid_t h5) {
                      remove(h5, scene);
                      H5Lcreate_external((folder() / "other.h5").c_str(), "/scene", h5, scene.c_str(),
                                         H5P_DEFAULT, H5P_DEFAULT);
                    }),
              HasSubstr("is a soft or external link"));
  EXPECT_THAT(after(system_,
                    [&](hid_t h5) {
                      const std::string path = "/parameters/springs/rest_length";
                      remove(h5, path);
                      const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), "properties");
                      const hsize_t count = system_.springs.size();
                      checked(
                          H5Pset_external(properties.get(), (folder() / "secret.bin").c_str(), 0, 8 * count),
                          "external");
                      create_dataset(h5, path, H5T_IEEE_F64LE, std::array{count}, properties);
                    }),
              HasSubstr("stores its numbers in another file"));
}

TEST_F(TraceDamage, IsSaidOfMoreThanAFileCanHold) {
  const auto grown = [&](const std::string& path, std::vector<hsize_t> shape) {
    return after(system_, [&](hid_t h5) {
      const Hdf5Dataset dataset(H5Dopen2(h5, path.c_str(), H5P_DEFAULT), path);
      checked(H5Dset_extent(dataset.get(), shape.data()), path);
    });
  };
  const hsize_t absurd = hsize_t{1} << 50;
  const std::string position = "/particles/cloth/position";
  // One more is what a run that was ended in the middle of a frame leaves.
  EXPECT_EQ(grown(position + "/value", {4, 20, 3}), "");
  EXPECT_THAT(grown(position + "/value", {absurd, 20, 3}), HasSubstr("different numbers of frames"));
  EXPECT_THAT(after(system_,
                    [&](hid_t h5) {
                      remove(h5, "/connectivity/springs");
                      const std::array<hsize_t, 2> shape{absurd, 2}, chunk{65536, 2};
                      create_dataset(h5, "/connectivity/springs", H5T_STD_U32LE, shape,
                                     chunked(chunk, Packing::deflated));
                    }),
              HasSubstr("larger than the file can hold"));
}

}  // namespace
}  // namespace mssim
