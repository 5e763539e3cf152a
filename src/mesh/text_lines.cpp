#include "mesh/text_lines.h"

#include <algorithm>

#include "geometry/geometry.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view blanks = " \t\f\v";

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  // The texts of ten million tetrahedra take half of this.
  constexpr std::size_t most_bytes = std::size_t{1} << 30;
  return read_file_or<InputError>(file, "give the file of a mesh", most_bytes);
}

TextLines::TextLines(std::string file, std::string_view text, const LineSigns& signs)
    : file_(std::move(file)), text_(without_byte_order_mark(text)), signs_(signs) {}

bool TextLines::next() {
  words_.clear();
  while (words_.empty()) {
    if (at_ >= text_.size()) return false;
    line_ = lines_ + 1;
    begin_ = at_;
    while (take_line() && at_ < text_.size()) {
    }
  }
  return true;
}

bool TextLines::take_line() {
  const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  std::string_view rest = text_.substr(at_, end - at_);
  at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
  ++lines_;
  constexpr std::size_t longest_line = std::size_t{1} << 20;
  if (end - begin_ > longest_line)
    fail("it has {} bytes, but a line may have at most {}; break the file into lines", end - begin_,
         longest_line);
  rest = rest.substr(0, rest.find(signs_.comment));
  while (true) {
    const std::size_t first = rest.find_first_not_of(blanks);
    if (first == std::string_view::npos) break;
    rest.remove_prefix(first);
    const std::size_t length = std::min(rest.find_first_of(blanks), rest.size());
    const std::string_view word = rest.substr(0, length);
    rest.remove_prefix(length);
    const bool is_last = rest.find_first_not_of(blanks) == std::string_view::npos;
    const bool is_continued = is_last && signs_.continuation != '\0' && word.back() == signs_.continuation;
    if (!is_continued || length > 1) words_.push_back(word.substr(0, length - (is_continued ? 1 : 0)));
    if (is_continued) return true;
  }
  return false;
}

void TextLines::require_next(const std::string& expected) {
  if (!next()) fail("the file ends before {}; it is truncated, so write it again", expected);
}

std::string TextLines::quoted(std::string_view word) {
  constexpr std::size_t longest = 40;
  return '"' + printable(word, longest) + '"';
}

Vec3d TextLines::point() const { return {coordinate(1, "x"), coordinate(2, "y"), coordinate(3, "z")}; }

double TextLines::coordinate(std::size_t index, std::string_view what) const {
  const std::string_view text = word(index, what);
  const auto value = number_in<double>(text);
  if (!value || !is_coordinate(*value)) fail("{} is {}; {}", what, quoted(text), coordinate_wanted);
  return *value;
}

std::int64_t TextLines::integer(std::size_t index, std::string_view what) const {
  const std::string_view text = word(index, what);
  const auto value = number_in<std::int64_t>(text);
  if (!value) fail("{} is {}; give a whole number", what, quoted(text));
  return *value;
}

void TextLines::fail_at(std::size_t line, const std::string& what) const {
  throw InputError("{}, line {}: {}", file_, std::max<std::size_t>(line, 1), what);
}

std::string_view TextLines::word(std::size_t index, std::string_view what) const {
  if (index >= words_.size()) fail("{} is missing; the line is cut off", what);
  return words_[index];
}

}  // namespace mssim
