#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mssim {

/// Thrown when an HDF5 call fails; what() is the reason from HDF5's error stack.
struct Hdf5Error : std::runtime_error {
  Hdf5Error(const std::string& action_, const std::string& reason, int error_number_)
      : std::runtime_error(reason), action(action_), error_number(error_number_) {}
  std::string action;  ///< the failed action, for example "creating /h5md"
  int error_number;    ///< the errno that HDF5 noted, 0 if none
};

/// Call before any other HDF5 function, in each thread. It stops HDF5 from locking files, which their writers
/// already do, from printing its error stack, and from flushing files at exit, where it crashes if a file
/// could not be written.
void prepare_hdf5();

/// Throws the Hdf5Error of the HDF5 call that has just failed.
[[noreturn]] void throw_hdf5_error(const std::string& action);

/// Returns the result of an HDF5 call, an identifier or a status; throws Hdf5Error if it is negative.
template <class Result>
Result checked(Result result, const std::string& action) {
  if (result < 0) throw_hdf5_error(action);
  return result;
}

/// Owns an HDF5 identifier of one kind.
template <herr_t (*close_identifier)(hid_t)>
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  /// Takes the result of an HDF5 call; throws Hdf5Error if the call failed.
  Hdf5Handle(hid_t identifier, const std::string& action) : identifier_(checked(identifier, action)) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : identifier_(other.release()) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(identifier_, other.identifier_);
    return *this;
  }
  ~Hdf5Handle() {
    if (identifier_ >= 0) close_identifier(identifier_);
  }
  hid_t get() const { return identifier_; }
  /// Closes now; throws Hdf5Error on failure, for example if data could not be written.
  void close(const std::string& action) { checked(close_identifier(release()), action); }
  /// Gives the identifier up without closing it.
  hid_t release() { return std::exchange(identifier_, -1); }

 private:
  hid_t identifier_ = -1;
};

/// Handles by kind of object.
using Hdf5File = Hdf5Handle<H5Fclose>;
using Hdf5Group = Hdf5Handle<H5Gclose>;
using Hdf5Dataset = Hdf5Handle<H5Dclose>;
using Hdf5Space = Hdf5Handle<H5Sclose>;
using Hdf5Type = Hdf5Handle<H5Tclose>;
using Hdf5Attribute = Hdf5Handle<H5Aclose>;
using Hdf5Properties = Hdf5Handle<H5Pclose>;

/// Makes sure that an open file, which will be named `name`, can grow by `bytes`: if HDF5 cannot write a file
/// to its end, the file is damaged, because its header announces more than there is. release_reserved_space()
/// returns what is left. Throws Hdf5Error and WriteError.
void reserve_room(hid_t file, const std::filesystem::path& name, std::size_t bytes);

/// Writing parts of an HDF5 file. Strings have fixed length, as H5MD requires, and are UTF-8 without a
/// terminator; numbers are little-endian. All functions throw Hdf5Error.

/// A new group; its parent groups must exist.
Hdf5Group create_group(hid_t parent, const std::string& path);

/// A new attribute of the object: a string, a number, or an array of numbers.
void write_attribute(hid_t object, const std::string& name, std::string_view text);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::int64_t value);
void write_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values);
/// An array of strings of one length.
void write_attribute(hid_t object, const std::string& name, std::span<const std::string_view> texts);
/// A reference to the object at `target`.
void write_reference(hid_t object, const std::string& name, hid_t file, const std::string& target);

/// A scalar dataset of one string; unlike an attribute it may exceed 64 KiB.
void write_text(hid_t parent, const std::string& name, std::string_view text);

/// A dataset of at least one string.
void write_texts(hid_t parent, const std::string& name, std::span<const std::string_view> texts);

/// A dataset of numbers of fixed size, none of its extents 0; `data` holds them in `memory_type`.
void write_array(hid_t parent, const std::string& path, hid_t file_type, hid_t memory_type,
                 std::span<const hsize_t> shape, const void* data);

/// A list of at least one number in double precision.
void write_numbers(hid_t parent, const std::string& path, std::span<const double> numbers);

/// Rows per chunk of a long list of tuples.
inline constexpr hsize_t tuples_per_chunk = 65536;

/// How the chunks of a dataset are stored. Every chunk has a Fletcher-32 checksum.
enum class Packing { plain, deflated };

/// Properties of a new dataset with these chunks.
Hdf5Properties chunked(std::span<const hsize_t> chunk, Packing packing);

/// A dataset of the given shape.
Hdf5Dataset create_dataset(hid_t parent, const std::string& path, hid_t type, std::span<const hsize_t> shape,
                           const Hdf5Properties& properties);

/// A dataset without rows, to which write_rows() adds them. `chunk`: extents of its chunks.
Hdf5Dataset create_series(hid_t parent, const std::string& path, hid_t type, std::span<const hsize_t> chunk,
                          Packing packing);

/// Grows the dataset's first dimension to first + count and writes the rows from `first` on; `data` holds
/// them in `memory_type`.
void write_rows(const Hdf5Dataset& dataset, const std::string& name, hsize_t first, hsize_t count,
                hid_t memory_type, const void* data);

/// Writes one row.
inline void write_row(const Hdf5Dataset& dataset, const std::string& name, hsize_t row, hid_t memory_type,
                      const void* data) {
  write_rows(dataset, name, row, 1, memory_type, data);
}

/// Thrown if the content of an HDF5 file cannot be used. what() is only the problem and its place:
/// "/connectivity/springs has 2 extents instead of 1".
struct Hdf5ContentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reading parts of an HDF5 file from any source, the counterpart of the writing functions. Nothing is read
/// before its type and size are checked, and nothing is allocated that the file cannot hold. Paths consist of
/// hard links only: other links may name any file of the machine. All functions throw Hdf5Error and
/// Hdf5ContentError.

/// Opens a file for reading, with the filter plugins in the machine's folders disabled.
Hdf5File open_for_reading(const std::filesystem::path& file);

/// Whether there is an object at `path`, which begins with '/'.
bool exists(hid_t file, const std::string& path);

/// The dataset at `path`; it must be stored in this file, with filters that mssim writes.
Hdf5Dataset open_dataset(hid_t file, const std::string& path);

/// Whether numbers are floating-point of 32 or 64 bits (is_real) or integers of 8 to 64 bits (is_integer), of
/// either byte order.
bool is_real(const Hdf5Type& type);
bool is_integer(const Hdf5Type& type);

/// A filter of a dataset's chunks.
struct Hdf5Filter {
  H5Z_filter_t number = 0;
  unsigned option = 0;  ///< the first one; for shuffle, the bytes of a number
};

/// The filters of a dataset in the order of writing.
std::vector<Hdf5Filter> filters_of(const Hdf5Dataset& dataset);

/// Throws unless the file can hold `items` of `bytes_per_item`, if each of its bytes stores at most `ratio`.
void require_room(hid_t file, const std::string& path, hsize_t items, hsize_t bytes_per_item,
                  hsize_t ratio = 1);

/// A dataset of one string, of fixed length or not, without its padding.
std::string read_text(hid_t file, const std::string& path);

/// A list of strings.
std::vector<std::string> read_texts(hid_t file, const std::string& path);

/// An attribute of one number (is_integer).
std::int64_t read_integer_attribute(hid_t file, const std::string& path, const std::string& name);

}  // namespace mssim
