#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

/// The whole content of a file. Throws InputError with one sentence when it cannot be read.
std::string read_text(const std::filesystem::path& file);

/// Special characters of a line format; '\0': none.
struct LineSigns {
  char comment = '#';        ///< begins a comment, which ends with the line
  char continuation = '\0';  ///< at the end of a line: the next line continues it
};

/// Iterates over the lines of a mesh file, splits them into words, and converts words to numbers. Lines end
/// in LF, CR LF or CR. Every error is an InputError that begins "FILE, line N: "; N is the first of continued
/// lines.
class TextLines {
 public:
  /// `text` must outlive this object; a UTF-8 byte-order mark at its start is skipped.
  TextLines(std::string file, std::string_view text, const LineSigns& signs = {});

  /// Advances to the next line that has words; false at the end. Throws if a line is longer than a megabyte:
  /// its words would take many times that.
  bool next();
  /// Advances to the next line that has words; throws at the end, naming `expected`.
  void require_next(const std::string& expected);

  /// The words of the line.
  const std::vector<std::string_view>& words() const { return words_; }
  /// The number of the line, from 1.
  std::size_t line() const { return line_; }
  /// Bytes of the whole text: an upper bound on its lines.
  std::size_t bytes() const { return text_.size(); }

  /// Words 1 to 3 as the coordinates of a point (is_coordinate).
  Vec3d point() const;
  /// Word `index` as a whole number; `what` names it in the message.
  std::int64_t integer(std::size_t index, std::string_view what) const;

  /// A word as shown in a message: in quotes, printable, truncated if long.
  static std::string quoted(std::string_view word);

  template <class... Values>
  [[noreturn]] void fail(fmt::format_string<Values...> what, Values&&... values) const {
    fail_at(line_, fmt::format(what, std::forward<Values>(values)...));
  }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

 private:
  /// Adds the next line's words to the statement; returns whether the line is continued.
  bool take_line();
  double coordinate(std::size_t index, std::string_view what) const;
  std::string_view word(std::size_t index, std::string_view what) const;

  std::string file_;
  std::string_view text_;
  LineSigns signs_;
  std::size_t at_ = 0;     ///< where the next line begins
  std::size_t line_ = 0;   ///< first line of the statement
  std::size_t lines_ = 0;  ///< lines read so far
  std::size_t begin_ = 0;  ///< where the statement begins
  std::vector<std::string_view> words_;
};

}  // namespace mssim
