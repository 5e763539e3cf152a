#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {

/// The whole content of a file. Throws InputError with one sentence when it cannot be read.
std::string read_text(const std::filesystem::path& file);

/// Goes through the lines of a mesh file, split into words, and turns words into numbers. Every error is a
/// InputError that begins "FILE, line N: ".
class TextLines {
 public:
  /// `text` must outlive this; what follows `comment` on a line is left out, and so is a byte-order mark of
  /// UTF-8 at the beginning.
  TextLines(std::string file, std::string_view text, char comment = '#');

  /// Goes to the next line that has words; false at the end. Throws for one of more than a megabyte: its
  /// words would take many times that.
  bool next();
  /// Goes to the next line that has words; throws at the end, where `expected` was to come.
  void require_next(const std::string& expected);

  /// The words of the line.
  const std::vector<std::string_view>& words() const { return words_; }
  /// The number of the line, from 1.
  std::size_t line() const { return line_; }
  /// Bytes of the whole text: no file holds more lines than that.
  std::size_t bytes() const { return text_.size(); }

  /// Word `index` as a coordinate (is_coordinate); `what` it is, for the message.
  double coordinate(std::size_t index, std::string_view what) const;
  /// Word `index` as a whole number.
  std::int64_t integer(std::size_t index, std::string_view what) const;

  /// A word for a message: in quotes, printable, cut off when long.
  static std::string quoted(std::string_view word);

  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

 private:
  std::string_view word(std::size_t index, std::string_view what) const;

  std::string file_;
  std::string_view text_;
  char comment_;
  std::size_t at_ = 0;  ///< where the next line begins
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace mssim
