#include "hdf5/hdf5_write.h"

#include <algorithm>
#include <array>
#include <vector>

namespace mssim {
namespace {

constexpr int max_rank = 3;

/// Fixed-length strings of `length` bytes; HDF5 knows none of length 0.
Hdf5Type string_type(std::size_t length) {
  Hdf5Type type(H5Tcopy(H5T_C_S1), "making a string type");
  checked(H5Tset_size(type.get(), std::max<std::size_t>(length, 1)), "setting a string's length");
  checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "setting a string's padding");
  checked(H5Tset_cset(type.get(), H5T_CSET_UTF8), "setting a string's encoding");
  return type;
}

Hdf5Space scalar_space() { return {H5Screate(H5S_SCALAR), "making a scalar space"}; }

Hdf5Space list_space(std::size_t count) {
  const hsize_t size = count;
  return {H5Screate_simple(1, &size, nullptr), "making a list's space"};
}

void write(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, const Hdf5Space& space,
           const void* data) {
  const std::string action = "writing attribute " + name;
  Hdf5Attribute attribute(H5Acreate2(object, name.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                          action);
  checked(H5Awrite(attribute.get(), memory_type, data), action);
  attribute.close(action);
}

/// Strings as HDF5 stores them: of one length, one behind the other.
struct PackedStrings {
  Hdf5Type type;
  std::string bytes;
};

PackedStrings packed(std::span<const std::string_view> texts) {
  PackedStrings strings{string_type(std::ranges::max(texts, {}, &std::string_view::size).size()), {}};
  for (const std::string_view text : texts) {
    strings.bytes += text;
    strings.bytes.append(H5Tget_size(strings.type.get()) - text.size(), '\0');
  }
  return strings;
}

void write_strings(hid_t object, const std::string& name, std::span<const std::string_view> texts,
                   const Hdf5Space& space) {
  const PackedStrings strings = packed(texts);
  write(object, name, strings.type.get(), strings.type.get(), space, strings.bytes.data());
}

void write_string_dataset(hid_t parent, const std::string& name, std::span<const std::string_view> texts,
                          const Hdf5Space& space) {
  const std::string action = "writing " + name;
  const PackedStrings strings = packed(texts);
  const hid_t type = strings.type.get();
  Hdf5Dataset dataset(
      H5Dcreate2(parent, name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), action);
  checked(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, strings.bytes.data()), action);
  dataset.close(action);
}

}  // namespace

Hdf5Group create_group(hid_t parent, const std::string& path) {
  return {H5Gcreate2(parent, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "creating group " + path};
}

void write_attribute(hid_t object, const std::string& name, std::string_view text) {
  write_strings(object, name, std::span(&text, 1), scalar_space());
}

void write_attribute(hid_t object, const std::string& name, double value) {
  write(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, scalar_space(), &value);
}

void write_attribute(hid_t object, const std::string& name, std::int64_t value) {
  write(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, scalar_space(), &value);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values) {
  write(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, list_space(values.size()), values.data());
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::string_view> texts) {
  write_strings(object, name, texts, list_space(texts.size()));
}

void write_reference(hid_t object, const std::string& name, hid_t file, const std::string& target) {
  hobj_ref_t reference{};
  checked(H5Rcreate(&reference, file, target.c_str(), H5R_OBJECT, -1), "referring to " + target);
  write(object, name, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, scalar_space(), &reference);
}

void write_text(hid_t parent, const std::string& name, std::string_view text) {
  write_string_dataset(parent, name, std::span(&text, 1), scalar_space());
}

void write_texts(hid_t parent, const std::string& name, std::span<const std::string_view> texts) {
  write_string_dataset(parent, name, texts, list_space(texts.size()));
}

void write_array(hid_t parent, const std::string& path, hid_t file_type, hid_t memory_type,
                 std::span<const hsize_t> shape, const void* data) {
  const std::string action = "writing " + path;
  Hdf5Dataset dataset =
      create_dataset(parent, path, file_type, shape, false, chunked(shape, Packing::deflated));
  checked(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), action);
  dataset.close(action);
}

void write_numbers(hid_t parent, const std::string& path, std::span<const double> numbers) {
  write_array(parent, path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::array<hsize_t, 1>{numbers.size()},
              numbers.data());
}

Hdf5Properties chunked(std::span<const hsize_t> chunk, Packing packing) {
  const std::string action = "setting how a dataset is stored";
  // The first level already finds what there is in floating-point numbers after shuffling.
  constexpr unsigned deflate_level = 1;
  Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), action);
  checked(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), action);
  if (packing == Packing::deflated) {
    checked(H5Pset_shuffle(properties.get()), action);
    checked(H5Pset_deflate(properties.get(), deflate_level), action);
  }
  checked(H5Pset_fletcher32(properties.get()), action);
  return properties;
}

Hdf5Dataset create_dataset(hid_t parent, const std::string& path, hid_t type, std::span<const hsize_t> shape,
                           bool grows, const Hdf5Properties& properties) {
  std::vector<hsize_t> limit(shape.begin(), shape.end());
  if (grows) limit.front() = H5S_UNLIMITED;
  const Hdf5Space space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), limit.data()),
                        "making the space of " + path);
  return {H5Dcreate2(parent, path.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
          "creating " + path};
}

void write_rows(const Hdf5Dataset& dataset, const std::string& name, hsize_t first, hsize_t count,
                hid_t memory_type, const void* data) {
  const std::string action = "writing " + name;
  std::array<hsize_t, max_rank> shape{}, start{};
  Hdf5Space space(H5Dget_space(dataset.get()), action);
  const int rank = checked(H5Sget_simple_extent_ndims(space.get()), action);
  checked(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), action);
  shape[0] = first + count;
  checked(H5Dset_extent(dataset.get(), shape.data()), action);
  shape[0] = count;
  start[0] = first;
  const Hdf5Space memory(H5Screate_simple(rank, shape.data(), nullptr), action);
  space = Hdf5Space(H5Dget_space(dataset.get()), action);
  checked(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, shape.data(), nullptr),
          action);
  checked(H5Dwrite(dataset.get(), memory_type, memory.get(), space.get(), H5P_DEFAULT, data), action);
}

}  // namespace mssim
