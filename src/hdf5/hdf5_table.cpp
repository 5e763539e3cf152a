#include "hdf5/hdf5_table.h"

#include <fmt/core.h>
#include <zlib.h>

#include <optional>
#include <type_traits>
#include <utility>

namespace mssim {
namespace {

/// Maximum expansion of a deflated byte: two bits of its stream can encode 258 bytes.
constexpr hsize_t most_deflated = 1032;
constexpr hsize_t fletcher32_bytes = 4;

/// Saturates at the largest hsize_t.
hsize_t product_of(const std::vector<hsize_t>& extents) {
  hsize_t product = 1;
  for (const hsize_t extent : extents)
    if (__builtin_mul_overflow(product, extent, &product)) return std::numeric_limits<hsize_t>::max();
  return product;
}

/// Inflated size of a zlib stream, or some number above `most`; nothing if the stream is damaged.
std::optional<hsize_t> inflated_bytes(std::vector<unsigned char>& deflated, hsize_t most) {
  z_stream stream{};
  if (::inflateInit(&stream) != Z_OK) return std::nullopt;
  std::array<unsigned char, std::size_t{1} << 16> block{};
  stream.next_in = deflated.data();
  int status = Z_OK;
  hsize_t bytes = 0, left = deflated.size();
  while (status == Z_OK && bytes <= most) {
    const auto taken = static_cast<uInt>(std::min<hsize_t>(left, std::numeric_limits<uInt>::max()));
    stream.avail_in = taken;
    stream.next_out = block.data();
    stream.avail_out = static_cast<uInt>(block.size());
    status = ::inflate(&stream, Z_NO_FLUSH);
    left -= taken - stream.avail_in;
    bytes += block.size() - stream.avail_out;
  }
  ::inflateEnd(&stream);
  return status == Z_STREAM_END || bytes > most ? std::optional(bytes) : std::nullopt;
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
    throw Hdf5ContentError(fmt::format("{} has the extents {} instead of {}", path_,
                                       extents_.empty() ? "of one number" : shown(extents_), shown(extents)));
  const Hdf5Type type(H5Dget_type(dataset_.get()), action);
  bytes_per_number_ = H5Tget_size(type.get());
  filters_ = filters_of(dataset_);
  const Hdf5Properties properties(H5Dget_create_plist(dataset_.get()), action);
  if (checked(H5Pget_layout(properties.get()), action) != H5D_CHUNKED) return;
  chunk_.resize(extents_.size());
  checked(H5Pget_chunk(properties.get(), static_cast<int>(chunk_.size()), chunk_.data()), action);
}

bool Hdf5Table::is_deflated() const {
  return std::ranges::find(filters_, H5Z_FILTER_DEFLATE, &Hdf5Filter::number) != filters_.end();
}

template <class Number>
std::vector<Number> Hdf5Table::read(hsize_t first_row, hsize_t rows) const {
  const std::string action = "reading " + path_;
  const Hdf5Type type(H5Dget_type(dataset_.get()), action);
  constexpr bool wants_reals = std::is_same_v<Number, double>;
  if (!(wants_reals ? is_real(type) : is_integer(type)))
    throw Hdf5ContentError(path_ + " has numbers of a type that mssim does not read");
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
  checked(H5Dread(dataset_.get(), wants_reals ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64, memory.get(),
                  space.get(), H5P_DEFAULT, numbers.data()),
          action);
  return numbers;
}
template std::vector<double> Hdf5Table::read(hsize_t first_row, hsize_t rows) const;
template std::vector<std::int64_t> Hdf5Table::read(hsize_t first_row, hsize_t rows) const;

void Hdf5Table::require_stored(hsize_t first_row, hsize_t rows) const {
  if (chunk_.empty()) {
    if (H5Dget_storage_size(dataset_.get()) / bytes_per_number_ < product_of(extents_))
      throw Hdf5ContentError(path_ + " is incomplete in the file");
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
    std::size_t axis = start.size() - 1;  // advances to the next chunk, along the last axis first
    while ((start[axis] += chunk_[axis]) >= (axis == 0 ? first_row + rows : extents_[axis])) {
      if (axis == 0) return;
      start[axis--] = 0;
    }
  }
}

hsize_t Hdf5Table::stored_bytes(const std::vector<hsize_t>& start) const {
  hsize_t stored = 0;
  checked(H5Dget_chunk_storage_size(dataset_.get(), start.data(), &stored), "reading " + path_);
  if (stored == 0) throw Hdf5ContentError(path_ + " is incomplete in the file");
  require_room(file_, path_, stored, 1);
  return stored;
}

/// HDF5 trusts the file about the length of a chunk and about skipped filters. It does not compare an
/// inflated chunk with its expected length, and would read beyond its end.
void Hdf5Table::require_whole_chunk(const std::vector<hsize_t>& start) const {
  std::vector<unsigned char> raw(stored_bytes(start));
  std::uint32_t left_out = 0;
  checked(H5Dread_chunk(dataset_.get(), H5P_DEFAULT, start.data(), &left_out, raw.data()),
          "reading " + path_);
  const hsize_t whole = product_of(chunk_) * bytes_per_number_;
  std::optional<hsize_t> bytes = raw.size();
  bool inflated = false;
  // Undo the filters from the last to the first.
  for (std::size_t i = filters_.size(); i-- > 0 && bytes;) {
    const bool applied = (left_out >> i & 1U) == 0;
    if (filters_[i].number == H5Z_FILTER_FLETCHER32) {
      if (!applied) throw Hdf5ContentError(path_ + " has a chunk without its checksum");
      *bytes -= std::min(*bytes, fletcher32_bytes);
      if (!inflated) raw.resize(*bytes);
    } else if (filters_[i].number == H5Z_FILTER_DEFLATE && applied) {
      if (std::exchange(inflated, true)) throw Hdf5ContentError(path_ + " is deflated twice");
      bytes = inflated_bytes(raw, whole + fletcher32_bytes);
    }
  }
  if (!bytes) return;  // HDF5 fails on it, too, and reports why
  if (*bytes != whole) throw Hdf5ContentError(path_ + " has a chunk of the wrong length");
}

std::vector<double> read_doubles(hid_t file, const std::string& path, const std::vector<hsize_t>& extents) {
  const Hdf5Table table(file, path, extents);
  return table.read<double>(0, table.rows());
}

std::vector<std::uint32_t> read_numbers(hid_t file, const std::string& path,
                                        const std::vector<hsize_t>& extents) {
  const Hdf5Table table(file, path, extents);
  std::vector<std::uint32_t> numbers;
  for (const std::int64_t number : table.read<std::int64_t>(0, table.rows())) {
    if (number < 0 || number > std::numeric_limits<std::uint32_t>::max())
      throw Hdf5ContentError(fmt::format("{} has the number {}, which is out of range", path, number));
    numbers.push_back(static_cast<std::uint32_t>(number));
  }
  return numbers;
}

}  // namespace mssim
