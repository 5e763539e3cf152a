#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hdf5/hdf5_handle.h"

namespace mssim {

/// Small pieces of an HDF5 file. Strings are of fixed length, as H5MD asks, UTF-8 without a terminator;
/// numbers are little-endian. All functions throw Hdf5Error.

/// A new group; the groups above it exist.
Hdf5Group create_group(hid_t parent, const std::string& path);

void write_attribute(hid_t object, const std::string& name, std::string_view text);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::int64_t value);
void write_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values);
/// An array of strings of one length.
void write_attribute(hid_t object, const std::string& name, std::span<const std::string_view> texts);
/// A reference to the object at `target`.
void write_reference(hid_t object, const std::string& name, hid_t file, const std::string& target);

/// A scalar dataset of one string; unlike attributes it may be longer than 64 KiB.
void write_text(hid_t parent, const std::string& name, std::string_view text);

/// A dataset of strings, one at least.
void write_texts(hid_t parent, const std::string& name, std::span<const std::string_view> texts);

/// A dataset of numbers that does not grow, none of its extents 0; `data` holds them in `memory_type`.
void write_array(hid_t parent, const std::string& path, hid_t file_type, hid_t memory_type,
                 std::span<const hsize_t> shape, const void* data);

/// A list of numbers in double precision, one at least.
void write_numbers(hid_t parent, const std::string& path, std::span<const double> numbers);

/// Rows in a chunk of a long list of tuples.
inline constexpr hsize_t tuples_per_chunk = 65536;

/// How the chunks of a dataset are stored. Every chunk has a Fletcher-32 checksum.
enum class Packing { plain, deflated };

/// Properties of a new dataset with these chunks.
Hdf5Properties chunked(std::span<const hsize_t> chunk, Packing packing);

/// A dataset of the given shape; the first dimension may grow when `grows`.
Hdf5Dataset create_dataset(hid_t parent, const std::string& path, hid_t type, std::span<const hsize_t> shape,
                           bool grows, const Hdf5Properties& properties);

/// Grows the dataset's first dimension to first + count and writes the rows from `first` on; `data` holds
/// them in `memory_type`.
void write_rows(const Hdf5Dataset& dataset, const std::string& name, hsize_t first, hsize_t count,
                hid_t memory_type, const void* data);

/// The same with one row.
inline void write_row(const Hdf5Dataset& dataset, const std::string& name, hsize_t row, hid_t memory_type,
                      const void* data) {
  write_rows(dataset, name, row, 1, memory_type, data);
}

}  // namespace mssim
