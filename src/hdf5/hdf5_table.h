#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "hdf5/hdf5.h"

namespace mssim {

/// Writes tuples of particles as H5MD's /connectivity stores them, with a reference to their group. An empty
/// list gets no dataset. Throws Hdf5Error.
template <std::size_t size>
void write_tuples(hid_t file, const std::string& path, const std::string& particles,
                  std::span<const std::array<std::uint32_t, size>> tuples) {
  if (tuples.empty()) return;
  const std::string action = "writing " + path;
  const std::array<hsize_t, 2> shape{tuples.size(), size};
  const std::array<hsize_t, 2> chunk{std::min(shape[0], tuples_per_chunk), size};
  const Hdf5Properties properties = chunked(chunk, Packing::deflated);
  // Readers of H5MD skip tuples with the fill value. HDF5's default is 0, a real node.
  constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();
  checked(H5Pset_fill_value(properties.get(), H5T_NATIVE_UINT32, &no_node), "setting a fill value");
  Hdf5Dataset dataset = create_dataset(file, path, H5T_STD_U32LE, shape, properties);
  checked(H5Dwrite(dataset.get(), H5T_NATIVE_UINT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, tuples.data()), action);
  write_reference(dataset.get(), "particles_group", file, particles);
  dataset.close(action);
}

/// Numbers in an HDF5 file from any source, possibly repacked: rows of one shape, of a type that is_real() or
/// is_integer() accepts, in chunks of any extents or none. Checksums are verified, and every chunk must be in
/// the file: HDF5 itself gives zeros for missing chunks. All functions throw Hdf5Error and Hdf5ContentError.
class Hdf5Table {
 public:
  static constexpr hsize_t any = H5S_UNLIMITED;  ///< an extent that may be any number
  /// A dataset with these extents; the first is the number of rows.
  Hdf5Table(hid_t file, std::string path, const std::vector<hsize_t>& extents);

  hsize_t rows() const { return extents_.front(); }
  hsize_t extent(std::size_t axis) const { return extents_.at(axis); }
  hsize_t bytes_per_number() const { return bytes_per_number_; }

  /// Throws unless these rows are in the file.
  void require_stored(hsize_t first_row, hsize_t rows) const;

  /// The numbers of some rows, row by row: double for floating-point numbers, std::int64_t for integers.
  template <class Number>
  std::vector<Number> read(hsize_t first_row, hsize_t rows) const;

 private:
  bool is_deflated() const;
  /// Calls `visit` with the first corner of each chunk of these rows.
  void each_chunk(hsize_t first_row, hsize_t rows,
                  const std::function<void(const std::vector<hsize_t>&)>& visit) const;
  /// The size of a chunk in the file, bytes.
  hsize_t stored_bytes(const std::vector<hsize_t>& start) const;
  void require_whole_chunk(const std::vector<hsize_t>& start) const;

  hid_t file_;
  std::string path_;
  Hdf5Dataset dataset_;
  std::vector<hsize_t> extents_;
  hsize_t bytes_per_number_ = 0;
  std::vector<Hdf5Filter> filters_;
  std::vector<hsize_t> chunk_;  ///< extents of a chunk; empty if the dataset is not chunked
};

/// All numbers of a dataset.
std::vector<double> read_doubles(hid_t file, const std::string& path, const std::vector<hsize_t>& extents);
/// Reads whole numbers of 32 bits without a sign.
std::vector<std::uint32_t> read_numbers(hid_t file, const std::string& path,
                                        const std::vector<hsize_t>& extents);

}  // namespace mssim
