#pragma once

#include <iterator>

#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "tests/support/output_fixture.h"
#include "tests/support/testing.h"

namespace mssim {

inline constexpr std::uint32_t cloth_rows = 4, cloth_columns = 5;

inline Energy energy_at(int frame) { return {1. / 3 * frame, 0.1 * frame, 7. - frame}; }

inline void write_frame(H5mdTrace& trace, const System& system, int frame) {
  trace.write_frame(10 * frame, 0.1 * frame, state_at(system, frame), energy_at(frame));
}

inline TraceHeader header() {
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

inline std::vector<hsize_t> shape_of(hid_t file, const std::string& path) {
  const Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), "opening " + path);
  const Hdf5Space space(H5Dget_space(dataset.get()), "space");
  std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get())));
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  return shape;
}

/// A string of fixed length.
inline std::string text_in(hid_t file, const std::string& path) {
  const Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), "opening " + path);
  const Hdf5Type type(H5Dget_type(dataset.get()), "type");
  std::string text(H5Tget_size(type.get()), '\0');
  checked(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "reading " + path);
  return text;
}

/// All bytes of a string, or an array of strings, in an attribute; checks that their length is fixed.
inline std::string text_attribute(hid_t file, const std::string& object, const std::string& name) {
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

inline Hdf5File open(const std::filesystem::path& file, unsigned mode = H5F_ACC_RDONLY) {
  prepare_hdf5();
  return {H5Fopen(file.c_str(), mode, H5P_DEFAULT), "opening " + file.string()};
}

inline std::vector<float> in_single_precision(const std::vector<Vec3d>& vectors) {
  std::vector<float> numbers;
  for (const Vec3d& vector : vectors)
    for (const double component : {vector.x, vector.y, vector.z})
      numbers.push_back(static_cast<float>(component));
  return numbers;
}

/// Expects a readable trace whose first `frames` frames are those of write_frame().
inline void expect_frames(const std::filesystem::path& trace, const System& system, int frames) {
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

class Trace : public TemporaryFolderTest {
 protected:
  std::filesystem::path file() const { return folder() / "run.h5"; }
  std::filesystem::path part() const { return temporary_of(file()); }
  void write(const System& system, int frames, const Surface& body = {}, bool in_double = false) const {
    TraceHeader head = header();
    head.in_double = in_double;
    H5mdTrace trace(file(), system, head, body);
    for (int frame = 0; frame < frames; ++frame) write_frame(trace, system, frame);
    trace.close();
  }
  void write(int frames) const { write(system_, frames); }
  const System system_ = small_cloth(cloth_rows, cloth_columns);
};

}  // namespace mssim
