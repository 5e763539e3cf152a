#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "text/error.h"

namespace mssim {

/// Comma-separated values as RFC 4180 has them, with line feeds alone as line ends.

/// A file is refused beyond this size, a million samples: its fields take many times that in memory.
inline constexpr std::size_t largest_csv_bytes = std::size_t{64} << 20;

/// Thrown when a CSV file cannot be read; what() is one sentence that names file, line and column, the value
/// and what to do.
struct CsvError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// One line, each field quoted where it has to be, with its line feed.
std::string csv_line(const std::vector<std::string>& fields);

/// The shortest decimal that reads back as the same number. Throws std::invalid_argument unless it is finite.
std::string csv_number(double value);
/// Empty for an absent value.
std::string csv_number(const std::optional<double>& value);

/// A table read from a file: a header and records of as many fields.
class CsvTable {
 public:
  /// Parses a text, which may begin with a byte-order mark; `name`, of the file it came from, stands in
  /// messages. Throws CsvError when a quote is left open or a record has not the header's length.
  CsvTable(std::string name, std::string_view text);

  /// Reads the table from a file. Throws CsvError when it cannot be read, too.
  explicit CsvTable(const std::filesystem::path& file);

  const std::vector<std::string>& header() const { return header_; }
  std::size_t size() const { return records_.size(); }
  /// Throws CsvError when the header does not begin with these columns.
  void require_columns(const std::vector<std::string_view>& columns) const;

  const std::string& text(std::size_t record, std::size_t column) const {
    return records_[record].fields[column];
  }
  /// Throws CsvError unless the whole field is a finite number.
  double number(std::size_t record, std::size_t column) const;
  /// Reads a number; none for an empty field.
  std::optional<double> optional_number(std::size_t record, std::size_t column) const;
  /// Throws CsvError unless the whole field is a whole number from 0 to 2^53.
  std::uint64_t count(std::size_t record, std::size_t column) const;
  /// Throws CsvError unless the field is "true" or "false".
  bool truth(std::size_t record, std::size_t column) const;
  /// The CsvError for a field: "FILE, line L, column NAME: "VALUE" COMPLAINT".
  CsvError complaint(std::size_t record, std::size_t column, const std::string& what) const;

 private:
  struct Record {
    std::size_t line = 0;  ///< of its first character, from 1
    std::vector<std::string> fields;
  };
  std::string name_;
  std::vector<std::string> header_;
  std::vector<Record> records_;
};

}  // namespace mssim
