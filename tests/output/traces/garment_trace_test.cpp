// Traces of garments: panels, joints, and the body that they are dressed on.
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <functional>
#include <utility>

#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "tests/support/trace_fixture.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class GarmentTrace : public Trace {
 protected:
  void write_garment_frames(int frames, const Surface& body = small_tetrahedron()) const {
    H5mdTrace trace(file(), garment_, header(), body);
    for (int frame = 0; frame < frames; ++frame) write_frame(trace, garment_, frame);
    trace.close();
  }
  std::vector<std::uint32_t> numbers(const std::string& path) const {
    return read<std::uint32_t>(open(file()).get(), path, H5T_NATIVE_UINT32);
  }
  /// A list of strings of one length, without what fills them up.
  std::vector<std::string> texts(const std::string& path) const {
    const Hdf5File h5 = open(file());
    const Hdf5Dataset dataset(H5Dopen2(h5.get(), path.c_str(), H5P_DEFAULT), path);
    const Hdf5Type type(H5Dget_type(dataset.get()), "type");
    const std::size_t length = H5Tget_size(type.get()), count = shape_of(h5.get(), path).at(0);
    std::string bytes(length * count, '?');
    checked(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), path);
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) texts.emplace_back(bytes.substr(i * length, length).c_str());
    return texts;
  }
  const System garment_ = two_panels();
};

TEST_F(GarmentTrace, NamesItsPanelsAndSaysWhereTheirNodesAre) {
  write_garment_frames(2);
  EXPECT_EQ(texts("/parameters/panels/name"), (std::vector<std::string>{"front \"left\" & more", "back"}));
  EXPECT_EQ(numbers("/parameters/panels/rows"), (std::vector<std::uint32_t>{3, 2}));
  EXPECT_EQ(numbers("/parameters/panels/columns"), (std::vector<std::uint32_t>{4, 5}));
  EXPECT_EQ(numbers("/parameters/panels/first_node"), (std::vector<std::uint32_t>{0, 12}));
  EXPECT_EQ(numbers("/parameters/panels/layer"), (std::vector<std::uint32_t>{0, 3}));
  const Hdf5File h5 = open(file());
  EXPECT_EQ(shape_of(h5.get(), "/particles/garment/position/value"), (std::vector<hsize_t>{2, 22, 3}));
  EXPECT_EQ(shape_of(h5.get(), "/particles/garment/velocity/value"), (std::vector<hsize_t>{2, 22, 3}));
  EXPECT_EQ(read<double>(h5.get(), "/particles/garment/mass", H5T_NATIVE_DOUBLE), garment_.node_mass);
  EXPECT_EQ(read<double>(h5.get(), "/observables/kinetic_energy/value", H5T_NATIVE_DOUBLE),
            (std::vector<double>{0, 1. / 3}));
  EXPECT_EQ(H5Aexists_by_name(h5.get(), "/parameters", "rows", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(h5.get(), "/connectivity/tetrahedra", H5P_DEFAULT), 0);
}

TEST_F(GarmentTrace, ListsSpringsAndJoints) {
  write_garment_frames(0);
  // Of 3 x 4 nodes: structural 2rc - r - c = 17, shear 2(r-1)(c-1) = 12, bending 2rc - 2r - 2c = 10; of 2 x 5
  // likewise 13 and 8, and bending along the rows alone: 2 * 3.
  EXPECT_EQ(numbers("/connectivity/springs").size(), 2U * (17 + 12 + 10 + 13 + 8 + 6));
  EXPECT_EQ(numbers("/connectivity/joints"), (std::vector<std::uint32_t>{11, 12, 13, 3, 17, 17}));
  EXPECT_EQ(numbers("/parameters/joints/seam"), (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(texts("/parameters/seams"), (std::vector<std::string>{"side", "hem"}));
  const Hdf5File h5 = open(file());
  EXPECT_EQ(shape_of(h5.get(), "/connectivity/joints"), (std::vector<hsize_t>{2, 3}));
  EXPECT_EQ(read<double>(h5.get(), "/parameters/joints/edge_share", H5T_NATIVE_DOUBLE),
            (std::vector<double>{0.25, 0}));
}

TEST_F(GarmentTrace, HoldsTheBodyOnceWhateverTheFrames) {
  write_garment_frames(1);
  const auto size_of_one = std::filesystem::file_size(file());
  const Hdf5File h5 = open(file());
  EXPECT_EQ(read<float>(h5.get(), "/body/points", H5T_NATIVE_FLOAT),
            in_single_precision(small_tetrahedron().points));
  EXPECT_EQ(shape_of(h5.get(), "/body/points"), (std::vector<hsize_t>{4, 3}));
  EXPECT_EQ(numbers("/body/triangles"), (std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}));
  // A body of 20,000 points adds its own size to traces of one and of twenty frames alike.
  Surface large = small_tetrahedron();
  for (int i = 0; i < 20000; ++i) large.points.push_back({std::sin(i), std::sin(3 * i), std::sin(5 * i)});
  write_garment_frames(1, large);
  const auto added_to_one = std::filesystem::file_size(file()) - size_of_one;
  write_garment_frames(20, large);
  const auto large_twenty = std::filesystem::file_size(file());
  write_garment_frames(20);
  const auto added_to_twenty = large_twenty - std::filesystem::file_size(file());
  EXPECT_GT(added_to_one, 100000U);
  EXPECT_LT(added_to_twenty, added_to_one + added_to_one / 10);
}

TEST_F(GarmentTrace, ShowsEachPanelOfEachFrameToXdmfReaders) {
  constexpr int frames = 3;
  write_garment_frames(frames);
  const Hdf5File h5 = open(file());
  const XdmfMesh mesh = xdmf_mesh_of(shape_of(garment_.topology), garment_.nodes(), small_tetrahedron());
  for (int frame = 0; frame < frames; ++frame) {
    const State state = state_at(garment_, frame);
    for (const auto& [vector, values] :
         {std::pair{"position", state.position}, std::pair{"velocity", state.velocity}}) {
      const std::vector<Vec3d> front(values.begin(), values.begin() + 12),
          back(values.begin() + 12, values.end());
      const std::string end = "/00000" + std::to_string(frame), folder = std::string("/xdmf/") + vector;
      EXPECT_EQ(xdmf_dataset(vector, mesh.parts[1], static_cast<std::size_t>(frame)), folder + "/1" + end);
      EXPECT_EQ(shape_of(h5.get(), folder + "/0" + end), (std::vector<hsize_t>{1, 3, 4, 3}));
      EXPECT_EQ(shape_of(h5.get(), folder + "/1" + end), (std::vector<hsize_t>{1, 2, 5, 3}));
      EXPECT_EQ(read<float>(h5.get(), folder + "/0" + end, H5T_NATIVE_FLOAT), in_single_precision(front));
      EXPECT_EQ(read<float>(h5.get(), folder + "/1" + end, H5T_NATIVE_FLOAT), in_single_precision(back));
    }
  }
  const auto panel = [&](const std::string& part) {
    return read<std::int32_t>(h5.get(), "/xdmf/panel/" + part, H5T_NATIVE_INT32);
  };
  EXPECT_EQ(panel("0"), std::vector<std::int32_t>(12, 0));
  EXPECT_EQ(panel("1"), std::vector<std::int32_t>(10, 1));
  EXPECT_EQ(panel("body"), std::vector<std::int32_t>(4, -1));
}

/// Whatever XDMF says about a dataset must be so, or viewers show nothing without a word.
void expect_dataset(hid_t h5, const std::string& item) {
  const auto between = [&](const std::string& before, const std::string& after) {
    const std::size_t begin = item.find(before) + before.size();
    return item.substr(begin, item.find(after, begin) - begin);
  };
  const std::string path = between(">run.h5:", "<"), number = between("NumberType=\"", "\"");
  std::string shape;
  for (const hsize_t extent : shape_of(h5, path))
    shape += (shape.empty() ? "" : " ") + std::to_string(extent);
  EXPECT_EQ(between("Dimensions=\"", "\""), shape) << path;
  const Hdf5Dataset dataset(H5Dopen2(h5, path.c_str(), H5P_DEFAULT), path);
  const Hdf5Type type(H5Dget_type(dataset.get()), path);
  EXPECT_EQ(H5Tget_size(type.get()), 4U) << path;
  EXPECT_EQ(between("Precision=\"", "\""), "4") << path;
  const bool is_float = H5Tget_class(type.get()) == H5T_FLOAT;
  EXPECT_EQ(number == "Float", is_float) << path;
  EXPECT_EQ(number == "Int", !is_float && H5Tget_sign(type.get()) == H5T_SGN_2) << path;
}

TEST_F(GarmentTrace, HasAnXdmfThatNamesNothingButWhatIsThere) {
  constexpr int frames = 3;
  write_garment_frames(frames);
  const std::string xdmf = text_of(folder() / "run.xdmf");
  const Hdf5File h5 = open(file());
  const auto count = [&](const std::string& word, const std::function<void(std::size_t)>& look = {}) {
    int found = 0;
    for (std::size_t at = xdmf.find(word); at != std::string::npos; at = xdmf.find(word, at + 1), ++found)
      if (look) look(at);
    return found;
  };
  // A frame names three datasets of each panel, and three of the body.
  EXPECT_EQ(count("<DataItem", [&](std::size_t at) { expect_dataset(h5.get(), xdmf.substr(at, 300)); }),
            frames * (2 * 3 + 3));
  EXPECT_EQ(count("CollectionType=\"Temporal\""), 1);
  EXPECT_EQ(count("CollectionType=\"Spatial\""), frames);
  EXPECT_EQ(count("<Time Value="), frames);
  EXPECT_EQ(count("<Grid Name=\"front &quot;left&quot; &amp; more\""), frames);
  EXPECT_EQ(count("<Grid Name=\"back\""), frames);
  EXPECT_EQ(count("<Grid Name=\"body\""), frames);
  EXPECT_EQ(count("TopologyType=\"3DSMesh\" Dimensions=\"1 3 4\""), frames);
  EXPECT_EQ(count("TopologyType=\"Triangle\" NumberOfElements=\"4\""), frames);
  EXPECT_EQ(count("<Grid"), count("</Grid>"));
}

TEST_F(GarmentTrace, NeedsNoBody) {
  write_garment_frames(2, {});
  EXPECT_THAT(text_of(folder() / "run.xdmf"), AllOf(HasSubstr("\"back\""), Not(HasSubstr("body"))));
  const Hdf5File h5 = open(file());
  EXPECT_EQ(H5Lexists(h5.get(), "/body", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(h5.get(), "/xdmf/panel/body", H5P_DEFAULT), 0);
}

TEST_F(GarmentTrace, KeepsItsFramesAndItsBodyWhenTheProcessIsKilled) {
  const int status = status_in_child([&] {
    H5mdTrace trace(file(), garment_, header(), small_tetrahedron());
    for (int frame = 0; frame < 5; ++frame) write_frame(trace, garment_, frame);
    return std::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  const Hdf5File h5 = open(part());
  EXPECT_EQ(shape_of(h5.get(), "/particles/garment/position/value"), (std::vector<hsize_t>{5, 22, 3}));
  std::vector<float> position;
  for (int frame = 0; frame < 5; ++frame)
    std::ranges::copy(in_single_precision(state_at(garment_, frame).position), std::back_inserter(position));
  EXPECT_EQ(read<float>(h5.get(), "/particles/garment/position/value", H5T_NATIVE_FLOAT), position);
  EXPECT_EQ(shape_of(h5.get(), "/body/triangles"), (std::vector<hsize_t>{4, 3}));
  EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST_F(GarmentTrace, LeavesNothingBehindWhereNotEvenTheBodyFits) {
  EXPECT_EQ(exit_of_child([&] {
              std::signal(SIGXFSZ, SIG_IGN);
              const rlimit limit{100000, 100000};
              ::setrlimit(RLIMIT_FSIZE, &limit);
              Surface large = small_tetrahedron();
              for (int i = 0; i < 20000; ++i)
                large.points.push_back({std::sin(i), std::sin(3 * i), std::sin(5 * i)});
              EXPECT_THAT([&] { H5mdTrace(file(), garment_, header(), large); },
                          testing::ThrowsMessage<WriteError>(HasSubstr("File too large")));
              EXPECT_TRUE(std::filesystem::is_empty(folder()));
              return testing::Test::HasFailure() ? 1 : 0;
            }),
            0);
}

TEST_F(GarmentTrace, RefusesWhatWouldPointBeyondItsNodes) {
  const auto refused = [&](const std::function<void(Garment&)>& change, const Surface& body = {}) {
    System system = garment_;
    change(garment_in(system));
    EXPECT_THROW(H5mdTrace(file(), system, header(), body), std::invalid_argument);
  };
  refused([](Garment& garment) { garment.panels.clear(); });
  refused([](Garment& garment) { garment.panels.pop_back(); });
  refused([](Garment& garment) { garment.panels[1].first_node = 11; });
  refused([](Garment& garment) { garment.panels[1].rows = 3; });
  refused([](Garment& garment) { garment.panels[1] = {"strip", 1, 10, 12}; });
  refused([](Garment& garment) { garment.joints[0].edge_second = 22; });
  refused([](Garment& garment) { garment.joints[1].seam = 2; });
  EXPECT_THAT(
      [] {
        require_fitting_shape({"garment", {}, {}, true}, 22);
      },
      testing::ThrowsMessage<std::invalid_argument>(HasSubstr("panels of all nodes")));
  const auto nothing = [](Garment&) {};
  Surface body = small_tetrahedron();
  body.triangles[3][1] = 4;
  refused(nothing, body);
  refused(nothing, {small_tetrahedron().points, {}});
  EXPECT_THROW(H5mdTrace(file(), system_, header(), small_tetrahedron()), std::invalid_argument)
      << "a cloth's body";
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

}  // namespace
}  // namespace mssim
