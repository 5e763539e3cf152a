#include "hdf5/hdf5_table.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "hdf5/hdf5_write.h"

namespace mssim {
namespace {

/// What deflation makes of a byte at most: two bits of its stream stand for 258 bytes.
constexpr hsize_t most_deflated = 1032;
constexpr hsize_t fletcher32_bytes = 4;

/// The largest number of all where the product is larger.
hsize_t product_of(const std::vector<hsize_t>& extents) {
  hsize_t product = 1;
  for (const hsize_t extent : extents)
    if (__builtin_mul_overflow(product, extent, &product)) return std::numeric_limits<hsize_t>::max();
  return product;
}

std::string shown(const std::vector<hsize_t>& extents) {
  std::string text;
  for (const hsize_t extent : extents)
    text += (text.empty() ? "" : " x ") + (extent == Hdf5Table::any ? "any" : std::to_string(extent));
  return text;
}

}  // namespace

Hdf5Table::Hdf5Table(hid_t file, std::string path, const std::vector<hsize_t>& extents)
    : file_(file), path_(std::move(path)), dataset_(open_dataset(file, path_)) {
  const std::string action = "looking up the extents of " + path_;
  const Hdf5Space space(H5Dget_space(dataset_.get()), action);
  extents_.resize(static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space.get()), action)));
  checked(H5Sget_simple_extent_dims(space.get(), extents_.data(), nullptr), action);
  const bool fits = std::ranges::equal(
      extents_, extents, [](hsize_t is, hsize_t wanted) { return wanted == any || is == wanted; });
  if (!fits)
    throw Hdf5ContentError(path_ + " has the extents " +
                           (extents_.empty() ? "of one number" : shown(extents_)) + " instead of " +
                           shown(extents));
  const Hdf5Type type(H5Dget_type(dataset_.get()), action);
  bytes_per_number_ = H5Tget_size(type.get());
  filters_ = filters_of(dataset_);
  const Hdf5Properties properties(H5Dget_create_plist(dataset_.get()), action);
  if (checked(H5Pget_layout(properties.get()), action) != H5D_CHUNKED) return;
  chunk_.resize(extents_.size());
  checked(H5Pget_chunk(properties.get(), static_cast<int>(chunk_.size()), chunk_.data()), action);
  std::vector<hsize_t> limits(extents_.size());
  checked(H5Sget_simple_extent_dims(space.get(), nullptr, limits.data()), action);
  require_written_chunks(limits.front() == H5S_UNLIMITED);
}

/// HDF5 does not compare what it inflates with the chunk that it should be, and would read on behind it.
/// Chunks that are not deflated have a length to compare.
void Hdf5Table::require_written_chunks(bool grows) const {
  if (!is_deflated()) return;
  const bool whole = std::equal(chunk_.begin() + 1, chunk_.end(), extents_.begin() + 1, extents_.end());
  const hsize_t rows = chunk_.front();
  if (!whole || (grows ? rows != 1 : rows != extents_.front() && rows != tuples_per_chunk))
    throw Hdf5ContentError(path_ + " is stored in parts of " + shown(chunk_) +
                           ", which mssim does not write");
}

bool Hdf5Table::is_deflated() const {
  return std::ranges::find(filters_, H5Z_FILTER_DEFLATE, &Hdf5Filter::number) != filters_.end();
}

std::vector<double> Hdf5Table::doubles(hsize_t first_row, hsize_t rows) const {
  return read<double>(first_row, rows, H5T_NATIVE_DOUBLE);
}

std::vector<std::int64_t> Hdf5Table::integers(hsize_t first_row, hsize_t rows) const {
  return read<std::int64_t>(first_row, rows, H5T_NATIVE_INT64);
}

template <class Number>
std::vector<Number> Hdf5Table::read(hsize_t first_row, hsize_t rows, hid_t memory_type) const {
  const std::string action = "reading " + path_;
  const Hdf5Type type(H5Dget_type(dataset_.get()), action);
  const std::array<hid_t, 2> known = std::is_same_v<Number, double>
                                         ? std::array<hid_t, 2>{H5T_IEEE_F32LE, H5T_IEEE_F64LE}
                                         : std::array<hid_t, 2>{H5T_STD_I64LE, H5T_STD_U32LE};
  if (std::ranges::none_of(known, [&](hid_t one) { return H5Tequal(type.get(), one) > 0; }))
    throw Hdf5ContentError(path_ + " has numbers of another type than mssim writes");
  if (rows > extents_.front() || first_row > extents_.front() - rows)
    throw Hdf5ContentError(path_ + " has too few rows");
  std::vector<hsize_t> start(extents_.size(), 0), shape = extents_;
  start.front() = first_row;
  shape.front() = rows;
  if (product_of(shape) == 0) return {};
  require_room(file_, path_, product_of(shape), bytes_per_number_, is_deflated() ? most_deflated : 1);
  require_stored(first_row, rows);
  if (!chunk_.empty())
    each_chunk(first_row, rows, [this](const auto& corner) { require_whole_chunk(corner); });
  std::vector<Number> numbers(product_of(shape));
  const Hdf5Space space(H5Dget_space(dataset_.get()), action);
  checked(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, shape.data(), nullptr),
          action);
  const Hdf5Space memory(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), action);
  checked(H5Dread(dataset_.get(), memory_type, memory.get(), space.get(), H5P_DEFAULT, numbers.data()),
          action);
  return numbers;
}

void Hdf5Table::require_stored(hsize_t first_row, hsize_t rows) const {
  if (chunk_.empty()) {
    if (H5Dget_storage_size(dataset_.get()) / bytes_per_number_ < product_of(extents_))
      throw Hdf5ContentError(path_ + " is not in the file as a whole");
    return;
  }
  require_room(file_, path_, product_of(chunk_), bytes_per_number_, is_deflated() ? most_deflated : 1);
  each_chunk(first_row, rows, [this](const auto& start) { stored_bytes(start); });
}

void Hdf5Table::each_chunk(hsize_t first_row, hsize_t rows,
                           const std::function<void(const std::vector<hsize_t>&)>& visit) const {
  std::vector<hsize_t> start(extents_.size(), 0);
  start.front() = first_row / chunk_.front() * chunk_.front();
  while (true) {
    visit(start);
    std::size_t axis = start.size() - 1;  // to the next one, along the last axis first
    while ((start[axis] += chunk_[axis]) >= (axis == 0 ? first_row + rows : extents_[axis])) {
      if (axis == 0) return;
      start[axis--] = 0;
    }
  }
}

hsize_t Hdf5Table::stored_bytes(const std::vector<hsize_t>& start) const {
  hsize_t stored = 0;
  checked(H5Dget_chunk_storage_size(dataset_.get(), start.data(), &stored), "reading " + path_);
  if (stored == 0) throw Hdf5ContentError(path_ + " is not in the file as a whole");
  require_room(file_, path_, stored, 1);
  return stored;
}

/// HDF5 trusts what the file says of how long a chunk is, and of filters that were left out of it.
void Hdf5Table::require_whole_chunk(const std::vector<hsize_t>& start) const {
  std::vector<char> raw(stored_bytes(start));
  std::uint32_t left_out = 0;
  checked(H5Dread_chunk(dataset_.get(), H5P_DEFAULT, start.data(), &left_out, raw.data()),
          "reading " + path_);
  const hsize_t bytes = product_of(chunk_) * bytes_per_number_;
  bool deflated = false;
  hsize_t checksum = 0;
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const bool applied = (left_out >> i & 1U) == 0;
    if (filters_[i].number == H5Z_FILTER_FLETCHER32 && !applied)
      throw Hdf5ContentError(path_ + " has a part without its checksum");
    if (filters_[i].number == H5Z_FILTER_FLETCHER32) checksum = fletcher32_bytes;
    if (filters_[i].number == H5Z_FILTER_DEFLATE && applied) deflated = true;
  }
  if (deflated ? raw.size() * most_deflated < bytes : raw.size() != bytes + checksum)
    throw Hdf5ContentError(path_ + " has a part of another length than it should be");
}

std::vector<double> read_doubles(hid_t file, const std::string& path, const std::vector<hsize_t>& extents) {
  const Hdf5Table table(file, path, extents);
  return table.doubles(0, table.rows());
}

std::vector<std::uint32_t> read_numbers(hid_t file, const std::string& path,
                                        const std::vector<hsize_t>& extents) {
  const Hdf5Table table(file, path, extents);
  std::vector<std::uint32_t> numbers;
  for (const std::int64_t number : table.integers(0, table.rows())) {
    if (number < 0 || number > std::numeric_limits<std::uint32_t>::max())
      throw Hdf5ContentError(path + " has the number " + std::to_string(number) + ", which it cannot be");
    numbers.push_back(static_cast<std::uint32_t>(number));
  }
  return numbers;
}

}  // namespace mssim
