#include "scene/fields/json_document.h"

#include <set>
#include <utility>
#include <vector>

#include "scene/fields/fields.h"
#include "text/text.h"

namespace mssim {
namespace {

using nlohmann::json;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) {
  throw SceneError(printable(file.string(), 1000) + ": " + problem);
}

/// The JSON library's account of a syntax error, "[json.exception.parse_error.101] parse error at line 1,
/// column 9: syntax error while parsing value - invalid literal; last read: '"a": N'", from "line" on. It
/// names what was expected except where it has found no token at all.
std::string syntax_problem(std::string_view message) {
  if (const std::size_t start = message.find("line "); start != std::string_view::npos)
    message.remove_prefix(start);
  std::string problem = printable(message, 300);
  // After an element the library asks for the closing bracket alone, though a comma is what is usually
  // missing.
  if (const std::size_t bracket = problem.find("; expected '"); bracket != std::string::npos) {
    const std::size_t at = bracket + std::string_view("; expected ").size();
    if (problem.compare(at, 3, "'}'") == 0 || problem.compare(at, 3, "']'") == 0)
      problem.insert(at, "',' or ");
  }
  const auto says = [&](std::string_view words) { return problem.find(words) != std::string::npos; };
  if (says("parsing value - invalid literal") && !says("; expected "))
    problem += "; expected an object, a number, a string in double quotes, true, false or null";
  return problem;
}

/// The text between the first and the last apostrophe: the number, in the library's message about an
/// overflow.
std::string quoted_part(std::string_view message) {
  const std::size_t first = message.find('\''), last = message.rfind('\'');
  return first < last ? printable(message.substr(first + 1, last - first - 1)) : std::string("a number");
}

/// Goes through a document ahead of the parser that keeps it: knows the place, and refuses what that lets
/// pass. (A callback of the keeping parser could do so too, but the library then goes through all elements of
/// a list after each: two million empty objects, 16 MB, take hours.)
class Watcher final : public json::json_sax_t {
 public:
  explicit Watcher(const std::filesystem::path& file) : file_(file) {}

  bool null() override { return next_element(); }
  bool boolean(bool /*value*/) override { return next_element(); }
  bool number_integer(number_integer_t /*value*/) override { return next_element(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return next_element(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return next_element(); }
  bool string(string_t& /*value*/) override { return next_element(); }
  bool binary(binary_t& /*value*/) override { return next_element(); }

  bool start_object(std::size_t /*elements*/) override { return start(false); }
  bool start_array(std::size_t /*elements*/) override { return start(true); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }

  bool key(string_t& name) override {
    levels_.back().key = name;
    if (!levels_.back().keys.insert(name).second)
      fail(file_, printable(pointer()) + " is given twice: keep one of the two");
    return true;
  }

  bool parse_error(std::size_t /*position*/, const std::string& /*last_token*/,
                   const json::exception& error) override {
    const std::string place = pointer();
    if (dynamic_cast<const json::out_of_range*>(&error) != nullptr)
      fail(file_, printable(place) + " is " + quoted_part(error.what()) +
                      ", which overflows to infinity: give a finite number");
    fail(file_, "malformed JSON" + (place.empty() ? "" : " near " + printable(place)) + ", " +
                    syntax_problem(error.what()) + ": correct the file there");
  }

 private:
  /// The value under way; at the top level the empty pointer.
  std::string pointer() const {
    std::string result;
    for (const Level& level : levels_)
      if (level.is_array)
        result = json_pointer(result, std::to_string(level.element));
      else if (!level.keys.empty())
        result = json_pointer(result, level.key);
    return result;
  }

  struct Level {
    bool is_array;
    std::size_t element;  ///< of an array, the one under way
    std::string key;      ///< of an object, the last one seen
    std::set<std::string> keys;
  };

  bool start(bool is_array) {
    if (levels_.size() == deepest_json_level)
      fail(file_, printable(pointer()) + " is nested deeper than " + std::to_string(deepest_json_level) +
                      " levels: a scene needs fewer, so remove the surplus brackets");
    levels_.push_back({is_array, 0, {}, {}});
    return true;
  }

  bool end() {
    levels_.pop_back();
    return next_element();
  }

  bool next_element() {
    if (!levels_.empty() && levels_.back().is_array) ++levels_.back().element;
    return true;
  }

  const std::filesystem::path& file_;
  std::vector<Level> levels_;
};

}  // namespace

nlohmann::json parse_json(const std::filesystem::path& file, const std::string& text) {
  if (text.empty()) fail(file, "is empty: give a scene file, or copy one from scenes/ and change it");
  // The JSON library takes it for the end.
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    fail(file,
         "malformed JSON, byte " + std::to_string(zero) + " (from 0) is zero, which no text has: remove it");
  Watcher watcher(file);
  json::sax_parse(text, &watcher);
  return json::parse(text);
}

std::string json_pointer(std::string_view pointer, std::string_view key) {
  std::string result(pointer);
  result += '/';
  for (const char c : key) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += c;
  }
  return result;
}

}  // namespace mssim
