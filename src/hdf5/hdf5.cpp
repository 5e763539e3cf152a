#include "hdf5/hdf5.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include "platform/files.h"

namespace mssim {
namespace {

struct Reason {
  std::string text;
  int error_number = 0;
};

/// Keeps the innermost entry of the error stack. If a system call failed, its text is "...: ..., errno = 28,
/// error message = 'No space left on device', ...".
herr_t note_innermost(unsigned depth, const H5E_error2_t* entry, void* reason_) {
  if (depth > 0) return 0;
  Reason& reason = *static_cast<Reason*>(reason_);
  reason.text = entry->desc ? entry->desc : "";
  constexpr std::string_view number_key = "errno = ", message_key = "error message = '";
  if (const std::size_t at = reason.text.find(number_key); at != std::string::npos)
    reason.error_number = std::atoi(reason.text.c_str() + at + number_key.size());
  if (const std::size_t at = reason.text.find(message_key); at != std::string::npos) {
    const std::size_t start = at + message_key.size();
    reason.text = reason.text.substr(start, reason.text.find('\'', start) - start);
  }
  return 0;
}

constexpr int max_rank = 3;

/// Fixed-length strings of `length` bytes; HDF5 does not allow length 0.
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

/// Strings as HDF5 stores them: of one length, contiguous.
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

Hdf5Dataset dataset_in(hid_t parent, const std::string& path, hid_t type, std::span<const hsize_t> shape,
                       std::span<const hsize_t> limit, const Hdf5Properties& properties) {
  const Hdf5Space space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), limit.data()),
                        "making the space of " + path);
  return {H5Dcreate2(parent, path.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
          "creating " + path};
}

/// Throws unless a dataset's bytes are in its own file, stored in a way that mssim writes. A virtual or
/// external dataset would read other files, and a third-party filter would run its code.
void require_known_storage(const Hdf5Dataset& dataset, const std::string& path) {
  const std::string action = fmt::format("looking up how {} is stored", path);
  const Hdf5Properties properties(H5Dget_create_plist(dataset.get()), action);
  if (checked(H5Pget_layout(properties.get()), action) == H5D_VIRTUAL ||
      checked(H5Pget_external_count(properties.get()), action) != 0)
    throw Hdf5ContentError(path + " stores its numbers in another file");
  const Hdf5Type type(H5Dget_type(dataset.get()), action);
  for (const Hdf5Filter& filter : filters_of(dataset)) {
    constexpr std::array known{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32};
    if (std::ranges::find(known, filter.number) == known.end())
      throw Hdf5ContentError(fmt::format(
          "{} is packed by filter {}, which mssim does not read; it reads shuffle, deflate and Fletcher32",
          path, filter.number));
    if (filter.number == H5Z_FILTER_SHUFFLE && filter.option != H5Tget_size(type.get()))
      throw Hdf5ContentError(path + " has a shuffle filter for numbers of another size");
  }
}

/// An HDF5 string without its padding.
std::string text_of(const char* bytes, std::size_t length, H5T_str_t padding) {
  std::string text(bytes, ::strnlen(bytes, length));
  if (padding == H5T_STR_SPACEPAD) text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace

void prepare_hdf5() {
  static std::once_flag once;
  std::call_once(once, [] {
    // HDF5 reads the variable once, at its first use. A file being written is locked by its AtomicFile;
    // HDF5's own locks would mistake that for another program's lock.
    ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
    H5dont_atexit();
  });
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // per thread
}

void throw_hdf5_error(const std::string& action) {
  Reason reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_innermost, &reason);
  if (reason.text.empty()) reason.text = "HDF5 gave no reason";
  throw Hdf5Error(action, reason.text, reason.error_number);
}

void reserve_room(hid_t file, const std::filesystem::path& name, std::size_t bytes) {
  void* descriptor = nullptr;
  checked(H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor), "asking for the file descriptor");
  const int error_number = reserve_space(*static_cast<const int*>(descriptor), bytes);
  if (error_number != 0)
    throw WriteError(write_failure(name, fmt::format("reserving {} bytes", bytes), error_number));
}

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
  Hdf5Dataset dataset = create_dataset(parent, path, file_type, shape, chunked(shape, Packing::deflated));
  checked(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), action);
  dataset.close(action);
}

void write_numbers(hid_t parent, const std::string& path, std::span<const double> numbers) {
  write_array(parent, path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::array<hsize_t, 1>{numbers.size()},
              numbers.data());
}

Hdf5Properties chunked(std::span<const hsize_t> chunk, Packing packing) {
  const std::string action = "setting how a dataset is stored";
  // Level 1 already achieves what is possible for floating-point numbers after shuffling.
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
                           const Hdf5Properties& properties) {
  return dataset_in(parent, path, type, shape, shape, properties);
}

Hdf5Dataset create_series(hid_t parent, const std::string& path, hid_t type, std::span<const hsize_t> chunk,
                          Packing packing) {
  std::vector<hsize_t> empty(chunk.begin(), chunk.end()), limit = empty;
  empty.front() = 0;
  limit.front() = H5S_UNLIMITED;
  return dataset_in(parent, path, type, empty, limit, chunked(chunk, packing));
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

Hdf5File open_for_reading(const std::filesystem::path& file) {
  prepare_hdf5();
  checked(H5PLset_loading_state(0), "turning off filter plugins");
  if (H5Fis_hdf5(file.c_str()) == 0) throw Hdf5ContentError("it is not an HDF5 file");
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), "opening"};
}

bool exists(hid_t file, const std::string& path) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end), action = "looking up " + part;
    if (checked(H5Lexists(file, part.c_str(), H5P_DEFAULT), action) == 0) return false;
    H5L_info_t link{};
    checked(H5Lget_info(file, part.c_str(), &link, H5P_DEFAULT), action);
    if (link.type != H5L_TYPE_HARD) throw Hdf5ContentError(part + " is a soft or external link");
    if (end == std::string::npos) return true;
    H5O_info_t object{};
    checked(H5Oget_info_by_name(file, part.c_str(), &object, H5P_DEFAULT), action);
    if (object.type != H5O_TYPE_GROUP) return false;  // nothing is in it
  }
}

Hdf5Dataset open_dataset(hid_t file, const std::string& path) {
  if (!exists(file, path)) throw Hdf5ContentError("there is no " + path);
  const std::string action = "opening " + path;
  H5O_info_t object{};
  checked(H5Oget_info_by_name(file, path.c_str(), &object, H5P_DEFAULT), action);
  if (object.type != H5O_TYPE_DATASET) throw Hdf5ContentError(path + " is not a dataset");
  Hdf5Dataset dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), action);
  require_known_storage(dataset, path);
  return dataset;
}

bool is_real(const Hdf5Type& type) {
  const std::array known{H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE};
  return std::ranges::any_of(known, [&](hid_t one) { return H5Tequal(type.get(), one) > 0; });
}

bool is_integer(const Hdf5Type& type) {
  constexpr std::size_t most_bytes = 8, bits_per_byte = 8;
  const std::size_t bytes = H5Tget_size(type.get());
  return H5Tget_class(type.get()) == H5T_INTEGER && bytes <= most_bytes && std::has_single_bit(bytes) &&
         H5Tget_precision(type.get()) == bytes * bits_per_byte;
}

std::vector<Hdf5Filter> filters_of(const Hdf5Dataset& dataset) {
  const std::string action = "looking up the filters of a dataset";
  const Hdf5Properties properties(H5Dget_create_plist(dataset.get()), action);
  std::vector<Hdf5Filter> filters(
      static_cast<std::size_t>(checked(H5Pget_nfilters(properties.get()), action)));
  for (std::size_t i = 0; i < filters.size(); ++i) {
    unsigned flags = 0;
    std::size_t options = 1;
    filters[i].number = checked(H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &options,
                                               &filters[i].option, 0, nullptr, nullptr),
                                action);
  }
  return filters;
}

void require_room(hid_t file, const std::string& path, hsize_t items, hsize_t bytes_per_item, hsize_t ratio) {
  if (bytes_per_item == 0) return;
  hsize_t bytes = 0;
  checked(H5Fget_filesize(file, &bytes), "asking for the length of the file");
  if (items > bytes * ratio / bytes_per_item)
    throw Hdf5ContentError(path + " claims to be larger than the file can hold");
}

std::vector<std::string> read_texts(hid_t file, const std::string& path) {
  const std::string action = "reading " + path;
  const Hdf5Dataset dataset = open_dataset(file, path);
  const Hdf5Type type(H5Dget_type(dataset.get()), action);
  const Hdf5Space space(H5Dget_space(dataset.get()), action);
  if (checked(H5Tget_class(type.get()), action) != H5T_STRING) throw Hdf5ContentError(path + " is not text");
  const H5T_str_t padding = checked(H5Tget_strpad(type.get()), action);
  const auto count = static_cast<hsize_t>(checked(H5Sget_simple_extent_npoints(space.get()), action));
  const std::size_t length = H5Tget_size(type.get());
  require_room(file, path, count, length);
  const auto read = [&](void* data) {
    return H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  };
  std::vector<std::string> texts;
  if (checked(H5Tis_variable_str(type.get()), action) > 0) {
    std::vector<char*> pointers(count, nullptr);
    const herr_t status = read(pointers.data());
    for (const char* text : pointers)
      texts.push_back(text ? text_of(text, std::strlen(text), padding) : std::string());
    H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, pointers.data());
    checked(status, action);
  } else {
    std::string bytes(count * length, '\0');
    checked(read(bytes.data()), action);
    for (std::size_t i = 0; i < count; ++i)
      texts.push_back(text_of(bytes.data() + i * length, length, padding));
  }
  return texts;
}

std::string read_text(hid_t file, const std::string& path) {
  std::vector<std::string> texts = read_texts(file, path);
  if (texts.size() != 1) throw Hdf5ContentError(path + " is not a single text");
  return texts.front();
}

std::int64_t read_integer_attribute(hid_t file, const std::string& path, const std::string& name) {
  const std::string place = fmt::format("attribute {} of {}", name, path), action = "reading " + place;
  if (!exists(file, path) ||
      checked(H5Aexists_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT), action) == 0)
    throw Hdf5ContentError(fmt::format("{} has no attribute {}", path, name));
  const Hdf5Attribute attribute(H5Aopen_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                                action);
  const Hdf5Type type(H5Aget_type(attribute.get()), action);
  const Hdf5Space space(H5Aget_space(attribute.get()), action);
  if (!is_integer(type) || H5Sget_simple_extent_npoints(space.get()) != 1)
    throw Hdf5ContentError(place + " is not a single number of a type that mssim reads");
  std::int64_t number = 0;
  checked(H5Aread(attribute.get(), H5T_NATIVE_INT64, &number), action);
  return number;
}

}  // namespace mssim
