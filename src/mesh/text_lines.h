#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mssim {

/// The whole content of a file. Throws InputError with one sentence when it cannot be read.
std::string read_text(const std::filesystem::path& file);

/// Signs of a format of lines; '\0' where it has none.
struct LineSigns {
  char comment = '#';        ///< what follows it on a line is left out
  char continuation = '\0';  ///< the last of a line: the next line belongs to it
};

/// Goes through the lines of a mesh file, split into words, and turns words into numbers. Lines end in LF, CR
/// LF or CR. Every error is a InputError that begins "FILE, line N: "; of lines that are continued, N is the
/// first.
class TextLines {
 public:
  /// `text` must outlive this; a byte-order mark of UTF-8 at its beginning is left out.
  TextLines(std::string file, std::string_view text, const LineSigns& signs = {});

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

  template <class... Values>
  [[noreturn]] void fail(fmt::format_string<Values...> what, Values&&... values) const {
    fail_at(line_, fmt::format(what, std::forward<Values>(values)...));
  }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

 private:
  /// Adds the words of the next line to those of the statement, and says whether it is continued.
  bool take_line();
  std::string_view word(std::size_t index, std::string_view what) const;

  std::string file_;
  std::string_view text_;
  LineSigns signs_;
  std::size_t at_ = 0;     ///< where the next line begins
  std::size_t line_ = 0;   ///< the first of the statement
  std::size_t lines_ = 0;  ///< up to there
  std::size_t begin_ = 0;  ///< where the statement begins
  std::vector<std::string_view> words_;
};

}  // namespace mssim
