#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "hdf5/hdf5_handle.h"

namespace mssim {

/// Thrown for what is in an HDF5 file and cannot be used. what() is the problem alone, which names the place:
/// "/connectivity/springs has 2 extents instead of 1".
struct Hdf5ContentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Small pieces of an HDF5 file that anybody may have written, the counterpart of hdf5_write.h. Nothing is
/// read before it is known to be what is asked for, and nothing is allocated that the file cannot hold. Paths
/// lead through hard links alone: other links may name any file of the machine. All functions throw Hdf5Error
/// and Hdf5ContentError.

/// Opens a file for reading; without the filters that HDF5 would look for in folders of the machine.
Hdf5File open_for_reading(const std::filesystem::path& file);

/// Whether there is an object at `path`, which begins with '/'.
bool exists(hid_t file, const std::string& path);

/// The dataset at `path`, which is stored in this file, by filters that hdf5_write.h uses.
Hdf5Dataset open_dataset(hid_t file, const std::string& path);

/// Whether numbers are floating-point ones of 32 or 64 bits, or integers of 8 to 64 bits, of either byte
/// order.
bool is_real(const Hdf5Type& type);
bool is_integer(const Hdf5Type& type);

/// What chunks go through when they are written.
struct Hdf5Filter {
  H5Z_filter_t number = 0;
  unsigned option = 0;  ///< the first, for shuffling the bytes of a number
};

/// The filters of a dataset in the order of writing.
std::vector<Hdf5Filter> filters_of(const Hdf5Dataset& dataset);

/// The length of a file in bytes.
hsize_t bytes_of(hid_t file);

/// Throws unless the file can hold so many `items` of `bytes_per_item`, each byte of it standing for `ratio`.
void require_room(hid_t file, const std::string& path, hsize_t items, hsize_t bytes_per_item,
                  hsize_t ratio = 1);

/// A dataset of one string, of fixed length or not, without what fills it up.
std::string read_text(hid_t file, const std::string& path);

/// A list of strings.
std::vector<std::string> read_texts(hid_t file, const std::string& path);

/// Whether the object at `path`, which exists, has an attribute.
bool has_attribute(hid_t file, const std::string& path, const std::string& name);

/// An attribute of one string, or of one number (is_real, is_integer).
std::string read_text_attribute(hid_t file, const std::string& path, const std::string& name);
double read_double_attribute(hid_t file, const std::string& path, const std::string& name);
std::int64_t read_integer_attribute(hid_t file, const std::string& path, const std::string& name);

}  // namespace mssim
