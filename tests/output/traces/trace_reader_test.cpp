#include "output/traces/trace_reader.h"

#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "hdf5/hdf5.h"
#include "tests/support/systems.h"
#include "tests/support/trace_fixture.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

using testing::HasSubstr;

class TraceReading : public Trace {
 protected:
  static constexpr int frames = 3;

  /// Writes frames and expects all that a trace says of any system to come back.
  TraceReader read_back(const System& system, bool in_double, const Surface& body = {}) const {
    write(system, frames, body, in_double);
    TraceReader reader(file());
    expect_content(reader, system, in_double);
    return reader;
  }
  static void expect_content(const TraceReader& reader, const System& system, bool in_double) {
    const TraceContent& content = reader.content();
    EXPECT_EQ(content.in_double, in_double);
    EXPECT_EQ(content.nodes, system.nodes());
    EXPECT_EQ(content.scene_json, header().scene_json);
    EXPECT_EQ(content.step, (std::vector<std::int64_t>{0, 10, 20}));
    EXPECT_EQ(content.time_s, (std::vector<double>{0, 0.1, 0.1 * 2}));
    EXPECT_EQ(content.springs.size(), system.springs.size());
    EXPECT_EQ(content.rest_length.size(), system.springs.size());
    for (std::size_t s = 0; s < content.springs.size(); ++s) {
      EXPECT_EQ(content.springs[s], (std::array{system.springs[s].first, system.springs[s].second}));
      EXPECT_EQ(content.rest_length[s], system.springs[s].rest_length);
    }
    EXPECT_EQ(reader.frames(), static_cast<std::size_t>(frames));
    for (int frame = 0; frame < frames; ++frame) {
      State state = state_at(system, frame);
      if (!in_double) round_to_single(state);
      EXPECT_EQ(reader.positions(static_cast<std::size_t>(frame)), state.position);
      EXPECT_EQ(reader.velocities(static_cast<std::size_t>(frame)), state.velocity);
    }
  }

  std::string refusal(const std::filesystem::path& trace, bool by_system = false) const {
    try {
      const TraceReader reader(trace);
    } catch (const TraceError& error) {
      EXPECT_EQ(error.exit_code == exit_file_error, by_system) << error.what();
      return error.what();
    }
    return "read";
  }
};

TEST_F(TraceReading, GivesBackACloth) {
  for (const bool in_double : {false, true}) {
    const TraceReader reader = read_back(system_, in_double);
    EXPECT_EQ(reader.content().shape.kind, "cloth");
    EXPECT_EQ(reader.content().shape.sheets.at(0).rows, cloth_rows);
    EXPECT_EQ(reader.content().shape.sheets.at(0).columns, cloth_columns);
    EXPECT_TRUE(reader.content().body.points.empty());
  }
}

TEST_F(TraceReading, GivesBackBodies) {
  const System system = two_solid_blocks();
  for (const bool in_double : {false, true}) {
    const TraceReader reader = read_back(system, in_double);
    EXPECT_EQ(reader.content().shape.kind, "bodies");
    EXPECT_EQ(reader.content().shape.tetrahedra, std::get<TetrahedralMesh>(system.topology).tetrahedra);
  }
}

TEST_F(TraceReading, GivesBackAGarmentAndItsBody) {
  const System system = two_panels();
  const auto& written = garment_in(system);
  for (const bool in_double : {false, true}) {
    const TraceReader reader = read_back(system, in_double, small_tetrahedron());
    EXPECT_EQ(reader.content().shape.kind, "garment");
    const std::vector<GarmentPanel>& panels = reader.content().shape.sheets;
    ASSERT_EQ(panels.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const GarmentPanel &is = panels[i], &was = written.panels[i];
      EXPECT_EQ(std::tie(is.name, is.rows, is.columns, is.first_node, is.layer),
                std::tie(was.name, was.rows, was.columns, was.first_node, was.layer));
    }
    EXPECT_EQ(in_single_precision(reader.content().body.points),
              in_single_precision(small_tetrahedron().points));
    EXPECT_EQ(reader.content().body.triangles, small_tetrahedron().triangles);
  }
}

TEST_F(TraceReading, TakesAGarmentWithoutSeamsAndACalmClothThatPacksWell) {
  read_back(garment_of({{3, 4, 0.01, {0, 0, 0}}}), false);
  const System large = small_cloth(100, 100);
  H5mdTrace trace(file(), large, header());
  trace.write_frame(0, 0, large.start, {});
  trace.close();
  EXPECT_EQ(TraceReader(file()).positions(0), large.start.position);
}

TEST_F(TraceReading, TakesThePartOfARunThatDidNotEnd) {
  {
    H5mdTrace trace(file(), system_, header());
    for (int frame = 0; frame < 2; ++frame) write_frame(trace, system_, frame);
  }
  const TraceReader reader(part());
  EXPECT_EQ(reader.frames(), 2U);
  State state = state_at(system_, 1);
  round_to_single(state);
  EXPECT_EQ(reader.positions(1), state.position);
}

TEST_F(TraceReading, TakesStringsOfAnyLength) {
  write(1);
  const Hdf5File h5 = open(file(), H5F_ACC_RDWR);
  checked(H5Ldelete(h5.get(), "/parameters/scene", H5P_DEFAULT), "deleting");
  const Hdf5Type type(H5Tcopy(H5T_C_S1), "type");
  checked(H5Tset_size(type.get(), H5T_VARIABLE), "size");
  const Hdf5Space space(H5Screate(H5S_SCALAR), "space");
  const char* text = "{\"name\": \"other\"}";
  Hdf5Dataset dataset(H5Dcreate2(h5.get(), "/parameters/scene", type.get(), space.get(), H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT),
                      "creating");
  checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &text), "writing");
  checked(H5Fflush(h5.get(), H5F_SCOPE_GLOBAL), "flushing");
  EXPECT_EQ(TraceReader(file()).content().scene_json, text);
}

TEST_F(TraceReading, SaysWhatItIsThatIsNoTrace) {
  EXPECT_THAT(refusal(folder() / "not-there.h5"), HasSubstr("not-there.h5: there is no such file: give"));
  EXPECT_THAT(refusal(folder()), HasSubstr("is not a regular file"));
  ASSERT_EQ(::mkfifo((folder() / "pipe.h5").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder() / "pipe.h5"), HasSubstr("is not a regular file"));
  EXPECT_THAT(refusal(put("text.h5", "time_s,kinetic_j\n")),
              HasSubstr("text.h5: it is not an HDF5 file: give"));
  EXPECT_THAT(refusal(put("empty.h5", "")), HasSubstr("not an HDF5 file"));
  write(1);
  EXPECT_THAT(refusal(folder() / "run.xdmf"), HasSubstr("run.h5"));
  std::filesystem::permissions(folder(), std::filesystem::perms{0755});
  std::filesystem::permissions(file(), std::filesystem::perms::none);
  expect_in_child([&] {
    ASSERT_TRUE(become_nobody());
    EXPECT_THAT(refusal(file(), true), HasSubstr("Permission denied"));
  });
}

TEST(Hdf5, PrintsNothingItselfInAnyThread) {
  prepare_hdf5();
  testing::internal::CaptureStderr();
  std::thread([] {
    prepare_hdf5();
    EXPECT_LT(H5Fopen("/no/such/file.h5", H5F_ACC_RDONLY, H5P_DEFAULT), 0);
  }).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(TraceReading, RefusesWhatOtherProgramsWrote) {
  prepare_hdf5();
  {
    const Hdf5File h5(H5Fcreate(file().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), "creating");
    create_group(h5.get(), "/results");
  }
  EXPECT_THAT(refusal(file()), HasSubstr("H5MD"));
  {
    const Hdf5File h5 = open(file(), H5F_ACC_RDWR);
    create_group(h5.get(), "/h5md");
    write_attribute(create_group(h5.get(), "/h5md/creator").get(), "name", std::string_view("GROMACS"));
  }
  EXPECT_THAT(refusal(file()), HasSubstr("there is none of /particles/cloth"));
}

TEST_F(TraceReading, TakesWhatOtherProgramsRepacked) {
  write(frames);
  const std::string particles = "/particles/cloth";
  const auto repack = [&](const std::string& path, hid_t type, std::vector<hsize_t> chunk, bool deflated) {
    const Hdf5File h5 = open(file(), H5F_ACC_RDWR);
    const std::vector<hsize_t> shape = shape_of(h5.get(), path);
    const std::vector<double> numbers = read<double>(h5.get(), path, H5T_NATIVE_DOUBLE);
    checked(H5Ldelete(h5.get(), path.c_str(), H5P_DEFAULT), path);
    const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), "properties");
    if (!chunk.empty())
      checked(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), path);
    if (deflated) {
      checked(H5Pset_fletcher32(properties.get()), path);
      checked(H5Pset_deflate(properties.get(), 9), path);
    }
    const Hdf5Dataset dataset = create_dataset(h5.get(), path, type, shape, properties);
    checked(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), path);
  };
  repack(particles + "/position/value", H5T_IEEE_F32BE, {2, 7, 2}, true);
  repack(particles + "/velocity/value", H5T_IEEE_F64LE, {3, 20, 3}, false);
  repack(particles + "/position/step", H5T_STD_U16BE, {2}, true);
  repack("/connectivity/springs", H5T_STD_I64BE, {}, false);
  repack("/parameters/springs/rest_length", H5T_IEEE_F64BE, {5}, true);
  const auto others = [&](const std::string& path, const std::string& name, hid_t type, hid_t memory,
                          const void* number) {
    const Hdf5File h5 = open(file(), H5F_ACC_RDWR);
    const Hdf5Space scalar(H5Screate(H5S_SCALAR), "space");
    checked(H5Adelete_by_name(h5.get(), path.c_str(), name.c_str(), H5P_DEFAULT), name);
    const Hdf5Attribute attribute(H5Acreate_by_name(h5.get(), path.c_str(), name.c_str(), type, scalar.get(),
                                                    H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                  name);
    checked(H5Awrite(attribute.get(), memory, number), name);
  };
  const int row_count = cloth_rows;
  others("/parameters", "rows", H5T_STD_U8LE, H5T_NATIVE_INT, &row_count);
  const Hdf5Type text(H5Tcopy(H5T_C_S1), "type");
  checked(H5Tset_size(text.get(), H5T_VARIABLE), "type");
  const char* creator = "another program";
  others("/h5md/creator", "name", text.get(), text.get(), &creator);

  const TraceReader reader(file());
  expect_content(reader, system_, false);
  EXPECT_EQ(reader.content().shape.sheets.at(0).rows, cloth_rows);
}

TEST_F(TraceReading, RefusesATraceWithoutFrames) {
  write(0);
  EXPECT_THAT(refusal(file()), HasSubstr("it has no frames"));
}

}  // namespace
}  // namespace mssim
