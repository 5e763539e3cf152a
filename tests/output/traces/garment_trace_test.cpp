// Traces of garments: panels, joints, and the body that they are dressed on.

#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "tests/support/testing.h"
#include "tests/support/trace_fixture.h"
#include "tests/support/trace_systems.h"

namespace mssim {
namespace {

class GarmentTrace : public Trace {
 protected:
  const System garment_ = two_panels();
};

TEST_F(GarmentTrace, HasAnXdmfWithEachPanelAndTheBodyInEachFrame) {
  constexpr int frames = 3;
  write(garment_, frames, small_tetrahedron());
  const std::string xdmf = read_file(folder() / "run.xdmf");
  const auto count = [&](const std::string& word) {
    int found = 0;
    for (std::size_t at = xdmf.find(word); at != std::string::npos; at = xdmf.find(word, at + 1)) ++found;
    return found;
  };
  for (const char* part :
       {"<Time Value=", "<Grid Name=\"front &quot;left&quot; &amp; more\"", "<Grid Name=\"back\"",
        "<Grid Name=\"body\"", "TopologyType=\"3DSMesh\" Dimensions=\"1 3 4\"",
        "TopologyType=\"Triangle\" NumberOfElements=\"4\""})
    EXPECT_EQ(count(part), frames) << part;
  EXPECT_EQ(count("<Grid"), count("</Grid>"));
}

TEST_F(GarmentTrace, SaysWherePanelsAreFlatAndWhatIsSewnToWhat) {
  write(garment_, 1);
  const Hdf5File h5 = open(file());
  const auto& written = garment_in(garment_);
  const auto flat = read<double>(h5.get(), "/parameters/panels/flat", H5T_NATIVE_DOUBLE);
  ASSERT_EQ(flat.size(), 2 * written.flat.size());
  for (std::size_t node = 0; node < written.flat.size(); ++node) {
    EXPECT_EQ(flat[2 * node], written.flat[node].x);
    EXPECT_EQ(flat[2 * node + 1], written.flat[node].y);
  }
  EXPECT_EQ(read<std::uint32_t>(h5.get(), "/connectivity/joints", H5T_NATIVE_UINT32),
            (std::vector<std::uint32_t>{11, 12, 13, 3, 17, 17}));
  EXPECT_EQ(read<double>(h5.get(), "/parameters/joints/edge_share", H5T_NATIVE_DOUBLE),
            (std::vector<double>{0.25, 0}));
  EXPECT_EQ(read<std::uint32_t>(h5.get(), "/parameters/joints/seam", H5T_NATIVE_UINT32),
            (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(read_texts(h5.get(), "/parameters/seams"), written.seams);
}

TEST_F(GarmentTrace, NeedsNoBody) {
  write(garment_, 2);
  EXPECT_THAT(read_file(folder() / "run.xdmf"), AllOf(HasSubstr("\"back\""), Not(HasSubstr("body"))));
  const Hdf5File h5 = open(file());
  EXPECT_EQ(H5Lexists(h5.get(), "/body", H5P_DEFAULT), 0);
  EXPECT_EQ(H5Lexists(h5.get(), "/xdmf/panel/body", H5P_DEFAULT), 0);
}

TEST_F(GarmentTrace, LeavesNothingBehindWhereNotEvenTheBodyFits) {
  expect_in_child([&] {
    limit_file_size(100000);
    Surface large = small_tetrahedron();
    for (int i = 0; i < 20000; ++i) large.points.push_back({std::sin(i), std::sin(3 * i), std::sin(5 * i)});
    EXPECT_THAT([&] { H5mdTrace(file(), garment_, header(), large); },
                testing::ThrowsMessage<WriteError>(HasSubstr("File too large")));
    EXPECT_TRUE(std::filesystem::is_empty(folder()));
  });
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
