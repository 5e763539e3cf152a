#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/fields/fields.h"
#include "text/text.h"

namespace mssim {

/// A value of a file, and the JSON pointer to it.
struct PlacedJson {
  const std::filesystem::path& file;
  std::string pointer;
  const nlohmann::json& value;
};

/// Values of a field: what to give, for messages, and their schema.
struct FieldValue {
  std::string wanted;
  std::function<nlohmann::ordered_json()> schema;
};

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// Maximum nesting level of a scene file.
constexpr std::size_t deepest_json_level = 32;

/// A JSON pointer (RFC 6901) to `key` in the object at `pointer`.
std::string json_pointer(std::string_view pointer, std::string_view key) {
  return std::string(pointer) + (json::json_pointer() / std::string(key)).to_string();
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) {
  throw SceneError("{}: {}", printable(file.string(), 1000), problem);
}

/// The JSON library's message about a syntax error, "[json.exception.parse_error.101] parse error at line 1,
/// column 9: syntax error while parsing value - invalid literal; last read: '"a": N'", from "line" on. The
/// library names the expected token unless it found no token at all, so that case is added.
std::string syntax_problem(std::string_view message) {
  if (const std::size_t start = message.find("line "); start != std::string_view::npos)
    message.remove_prefix(start);
  std::string problem = printable(message, 300);
  // After an element the library expects only the closing bracket, but usually a comma is missing.
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

/// The text between the first and the last apostrophe: the number in the library's message about an overflow.
std::string quoted_part(std::string_view message) {
  const std::size_t first = message.find('\''), last = message.rfind('\'');
  return first < last ? printable(message.substr(first + 1, last - first - 1)) : std::string("a number");
}

/// Parses a document before the parser that builds it, tracks the current location, and refuses what that
/// parser accepts. (A callback of the building parser could do so too, but the library then visits all
/// elements of a list after each one: two million empty objects, 16 MB, take hours.)
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
      fail(file_, fmt::format("{} is {}, which overflows to infinity: give a finite number", printable(place),
                              quoted_part(error.what())));
    fail(file_, fmt::format("malformed JSON{}, {}: correct the file there",
                            place.empty() ? "" : " near " + printable(place), syntax_problem(error.what())));
  }

 private:
  /// Pointer to the current value; empty at the top level.
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
    std::size_t element;  ///< in an array: index of the current element
    std::string key;      ///< in an object: the last key
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

/// Parses a text strictly: no comments, no duplicate keys (of which the JSON library would keep the last), no
/// number that overflows, at most `deepest_json_level` levels. `file` is its source. Throws SceneError.
json parse_json(const std::filesystem::path& file, const std::string& text) {
  if (text.empty()) fail(file, "is empty: give a scene file, or copy one from scenes/ and change it");
  // The JSON library treats it as the end.
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
    fail(file, fmt::format("malformed JSON, byte {} (from 0) is zero, which text must not contain: remove it",
                           zero));
  Watcher watcher(file);
  json::sax_parse(text, &watcher);
  return json::parse(text);
}

std::string described(const json& value) {
  switch (value.type()) {
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return "a list";
    case json::value_t::string:
      return fmt::format("the text \"{}\"", printable(value.get_ref<const std::string&>()));
    default:
      return value.dump();
  }
}

std::string described(const Range& range) {
  return (range.minimum_excluded ? "above " : "from ") + shown_number(range.minimum) +
         (range.minimum_excluded ? " and up to " : " to ") + shown_number(range.maximum);
}

bool contains(const Range& range, double number) {
  return (range.minimum_excluded ? number > range.minimum : number >= range.minimum) &&
         number <= range.maximum;
}

/// Characters of valid UTF-8 (the parser refuses anything else).
std::size_t count_characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

[[noreturn]] void refuse(const PlacedJson& found, std::string_view wanted) {
  mssim::refuse(found.file, found.pointer, fmt::format("is {}: give {}", described(found.value), wanted));
}

/// A member of an object, or an element of a list.
PlacedJson member(const PlacedJson& object, std::string_view key, const json& value) {
  return {object.file, json_pointer(object.pointer, key), value};
}

/// The elements of a list, which must be `least` to `most`.
std::vector<PlacedJson> elements(const PlacedJson& list, std::size_t least, std::size_t most,
                                 const std::string& wanted) {
  if (!list.value.is_array()) refuse(list, wanted);
  if (list.value.size() < least || list.value.size() > most)
    mssim::refuse(list.file, list.pointer,
                  fmt::format("has {}: give {}", pluralize(list.value.size(), "element"), wanted));
  std::vector<PlacedJson> all;
  for (const json& element : list.value) all.push_back(member(list, std::to_string(all.size()), element));
  return all;
}

double number_of(const PlacedJson& found, const Range& range, const std::string& wanted) {
  if (found.value.is_number())
    if (const auto number = found.value.get<double>(); contains(range, number)) return number;
  refuse(found, wanted);
}

double component(const PlacedJson& list, std::size_t i, const Range& each) {
  return number_of(member(list, std::to_string(i), list.value[i]), each, "a number " + described(each));
}

std::string one_text(std::size_t longest) {
  return fmt::format("one line of text of at most {} characters", longest);
}

std::string text_of(const PlacedJson& found, std::size_t longest) {
  if (found.value.is_string()) {
    const auto& text = found.value.get_ref<const std::string&>();
    const bool one_line =
        std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (one_line && count_characters(text) <= longest) return text;
  }
  refuse(found, one_text(longest));
}

std::string some_texts(std::size_t most) { return fmt::format("a list, [ ... ], of 1 to {} texts", most); }

std::string one_of_texts(std::span<const std::string_view> words) {
  return "the text " + listed(words, "or");
}

ordered_json schema_of_choice(std::span<const std::string_view> words) {
  return {{"type", "string"}, {"enum", words}};
}

/// The index of a text in `words`.
std::size_t choice_of(const PlacedJson& found, std::span<const std::string_view> words) {
  const std::string wanted = one_of_texts(words);
  if (!found.value.is_string()) refuse(found, wanted);
  const auto& word = found.value.get_ref<const std::string&>();
  const auto match = std::find(words.begin(), words.end(), word);
  if (match != words.end()) return static_cast<std::size_t>(match - words.begin());
  const std::string_view nearest = words.size() > 1 ? nearest_name(word, words) : "";
  refuse(found, nearest.empty() ? wanted : fmt::format("{}, perhaps {}", wanted, nearest));
}

/// Writes whole numbers without a decimal point.
ordered_json number(double value) {
  return value == std::trunc(value) ? ordered_json(static_cast<std::int64_t>(value)) : ordered_json(value);
}

ordered_json numbers(const char* type, const Range& range) {
  return {{"type", type},
          {range.minimum_excluded ? "exclusiveMinimum" : "minimum", number(range.minimum)},
          {"maximum", number(range.maximum)}};
}

ordered_json array_of(ordered_json items, std::size_t least, std::size_t most) {
  return {{"type", "array"}, {"minItems", least}, {"maxItems", most}, {"items", std::move(items)}};
}

ordered_json texts_of(std::size_t longest) {
  return {{"type", "string"}, {"maxLength", longest}, {"pattern", "^[^\\u0000-\\u001f]*$"}};
}

/// Assigns the values of an object to the fields.
void read_object(const PlacedJson& object, const FieldList& fields);

/// The schema of an object with these fields.
ordered_json schema_of(const FieldList& fields);

}  // namespace

void FieldVisitor::number(const Field& field, double& target, const Range& range) {
  const std::string wanted = "a number " + described(range);
  visit(field, Presence::required, {wanted, [&] { return numbers("number", range); }},
        [&](const PlacedJson& found) { target = number_of(found, range, wanted); });
}

void FieldVisitor::optional_number(const Field& field, std::optional<double>& target, const Range& range) {
  const std::string wanted = "a number " + described(range);
  visit(field, Presence::optional, {wanted, [&] { return numbers("number", range); }},
        [&](const PlacedJson& found) { target = number_of(found, range, wanted); });
}

void FieldVisitor::number_or_auto(const Field& field, std::optional<double>& target, const Range& range) {
  const std::string wanted = fmt::format("a number {}, or \"auto\"", described(range));
  visit(field, Presence::required,
        {wanted,
         [&]() -> ordered_json {
           return {{"oneOf", {numbers("number", range), {{"const", "auto"}}}}};
         }},
        [&](const PlacedJson& found) {
          target = found.value == "auto" ? std::nullopt : std::optional(number_of(found, range, wanted));
        });
}

void FieldVisitor::integer(const Field& field, std::uint32_t& target, std::uint32_t minimum,
                           std::uint32_t maximum) {
  const Range range = from(minimum, maximum);
  const std::string wanted = "an integer " + described(range);
  visit(field, Presence::required, {wanted, [&] { return numbers("integer", range); }},
        [&](const PlacedJson& found) {
          const double number = number_of(found, range, wanted);
          if (number != std::floor(number)) refuse(found, wanted);
          target = static_cast<std::uint32_t>(number);
        });
}

void FieldVisitor::text(const Field& field, Presence presence, std::string& target) {
  visit(field, presence, {one_text(longest_text), [] { return texts_of(longest_text); }},
        [&](const PlacedJson& found) { target = text_of(found, longest_text); });
}

void FieldVisitor::texts(const Field& field, std::size_t most, std::size_t longest,
                         std::vector<std::string>& target) {
  const std::string wanted = some_texts(most);
  visit(field, Presence::required, {wanted, [&] { return array_of(texts_of(longest), 1, most); }},
        [&](const PlacedJson& list) {
          target.clear();
          for (const PlacedJson& text : elements(list, 1, most, wanted))
            target.push_back(text_of(text, longest));
        });
}

void FieldVisitor::named_texts(const Field& field, std::size_t most, std::size_t longest,
                               std::vector<std::pair<std::string, std::string>>& target) {
  const std::string wanted = fmt::format("an object, {{ ... }}, of at most {} texts", most);
  visit(field, Presence::optional,
        {wanted,
         [&]() -> ordered_json {
           return {{"type", "object"}, {"maxProperties", most}, {"additionalProperties", texts_of(longest)}};
         }},
        [&](const PlacedJson& object) {
          if (!object.value.is_object() || object.value.size() > most) refuse(object, wanted);
          target.clear();
          for (const auto& [name, text] : object.value.items())
            target.emplace_back(name, text_of(member(object, name, text), longest));
        });
}

void FieldVisitor::choice(const Field& field, Presence presence, std::span<const std::string_view> words,
                          std::uint32_t& target) {
  visit(field, presence, {one_of_texts(words), [&] { return schema_of_choice(words); }},
        [&](const PlacedJson& found) { target = static_cast<std::uint32_t>(choice_of(found, words)); });
}

void FieldVisitor::choices(const Field& field, std::span<const std::string_view> words,
                           std::vector<std::string>& target) {
  const std::string wanted = some_texts(words.size());
  visit(field, Presence::optional,
        {wanted, [&] { return array_of(schema_of_choice(words), 1, words.size()); }},
        [&](const PlacedJson& list) {
          target.clear();
          for (const PlacedJson& text : elements(list, 1, words.size(), wanted))
            target.emplace_back(words[choice_of(text, words)]);
        });
}

void FieldVisitor::vector(const Field& field, Presence presence, Vec3d& target, const Range& each) {
  const std::string wanted = "a list of three numbers " + described(each);
  visit(field, presence, {wanted, [&] { return array_of(numbers("number", each), 3, 3); }},
        [&](const PlacedJson& list) {
          if (!list.value.is_array() || list.value.size() != 3) refuse(list, wanted);
          target = {component(list, 0, each), component(list, 1, each), component(list, 2, each)};
        });
}

void FieldVisitor::points(const Field& field, std::size_t least, std::size_t most, const Range& each,
                          std::vector<Vec3d>& target) {
  const std::string wanted = fmt::format("a list, [ ... ], of {} to {} points [x, y]", least, most);
  visit(field, Presence::required,
        {wanted, [&] { return array_of(array_of(numbers("number", each), 2, 2), least, most); }},
        [&](const PlacedJson& list) {
          target.clear();
          for (const PlacedJson& point : elements(list, least, most, wanted)) {
            if (!point.value.is_array() || point.value.size() != 2)
              refuse(point, "a point, two numbers [x, y]");
            target.push_back({component(point, 0, each), component(point, 1, each), 0});
          }
        });
}

void FieldVisitor::list(const Field& field, Presence presence, std::size_t most, std::string_view description,
                        const FieldList& fields) {
  const std::string wanted = fmt::format("a list, [ ... ], of 1 to {} objects", most);
  visit(field, presence,
        {wanted,
         [&] {
           ordered_json element{{"description", description}};
           element.update(schema_of(fields));
           return array_of(std::move(element), 1, most);
         }},
        [&](const PlacedJson& list) {
          for (const PlacedJson& object : elements(list, 1, most, wanted)) read_object(object, fields);
        });
}

void FieldVisitor::object(const Field& field, Presence presence, const FieldList& fields) {
  visit(field, presence, {"an object, { ... }", [&] { return schema_of(fields); }},
        [&](const PlacedJson& object) { read_object(object, fields); });
}

namespace {

std::vector<std::string_view> keys_of(std::span<const Section> sections) {
  return mapped<std::string_view>(sections, [](const Section& section) { return section.field.key; });
}

/// Reads one object. Misspelled keys explain missing ones, so both are reported at the end, misspelled ones
/// first.
class JsonReader final : public FieldVisitor {
 public:
  explicit JsonReader(const PlacedJson& object) : object_(object) {
    if (!object.value.is_object())
      refuse({object.file, object.pointer.empty() ? "the top level" : object.pointer, object.value},
             "an object, { ... }");
  }

  void one_of(const Field& field, std::span<const Section> sections) override {
    const std::vector<std::string_view> names = keys_of(sections);
    auto chosen = static_cast<std::uint32_t>(names.size());
    choice(field, Presence::required, names, chosen);
    if (chosen < names.size())
      object(sections[chosen].field, Presence::required, sections[chosen].fields);
    else
      known_.insert(known_.end(), names.begin(), names.end());
  }

  /// Call once, after all fields have been visited.
  void finish() const {
    for (const auto& [key, value] : object_.value.items()) {
      if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
      std::string problem = "is not a known key (its value is ";
      problem += described(value);
      problem += "): ";
      const std::string_view nearest = nearest_name(key, known_);
      if (nearest.empty()) fail_at(key, problem + "known here are " + listed(known_));
      fail_at(key, fmt::format("{}did you mean \"{}\"?", problem, nearest));
    }
    if (!missing_.empty()) mssim::refuse(object_.file, missing_, missing_remedy_);
  }

 private:
  void visit(const Field& field, Presence presence, const FieldValue& value,
             const std::function<void(const PlacedJson& found)>& take) override {
    known_.push_back(field.key);
    const auto match = object_.value.find(std::string(field.key));
    if (match != object_.value.end()) return take(member(object_, field.key, *match));
    if (presence == Presence::required && missing_.empty()) {
      missing_ = json_pointer(object_.pointer, field.key);
      missing_remedy_ = "is missing: add it as " + value.wanted;
    }
  }

  [[noreturn]] void fail_at(std::string_view key, const std::string& problem) const {
    mssim::refuse(object_.file, json_pointer(object_.pointer, key), problem);
  }

  const PlacedJson& object_;
  std::vector<std::string_view> known_;
  std::string missing_;  ///< pointer to the first missing required key
  std::string missing_remedy_;
};

void read_object(const PlacedJson& object, const FieldList& fields) {
  JsonReader reader(object);
  fields(reader);
  reader.finish();
}

/// Describes one object.
class SchemaWriter final : public FieldVisitor {
 public:
  void one_of(const Field& field, std::span<const Section> sections) override {
    std::uint32_t unused = 0;
    choice(field, Presence::required, keys_of(sections), unused);
    for (const Section& section : sections) {
      object(section.field, Presence::optional, section.fields);
      const ordered_json present{{"required", {section.field.key}}};
      conditions_.push_back({{"if", {{"properties", {{field.key, {{"const", section.field.key}}}}}}},
                             {"then", present},
                             {"else", {{"not", present}}}});
    }
  }

  ordered_json schema() const {
    ordered_json schema{{"type", "object"},
                        {"additionalProperties", false},
                        {"required", required_},
                        {"properties", properties_}};
    if (!conditions_.empty()) schema["allOf"] = conditions_;
    return schema;
  }

 private:
  void visit(const Field& field, Presence presence, const FieldValue& value,
             const std::function<void(const PlacedJson& found)>& /*take*/) override {
    ordered_json& property = properties_[std::string(field.key)];
    property = {{"description", field.description}};
    property.update(value.schema());
    if (presence == Presence::required) required_.push_back(field.key);
  }

  ordered_json required_ = ordered_json::array(), properties_ = ordered_json::object(),
               conditions_ = ordered_json::array();
};

ordered_json schema_of(const FieldList& fields) {
  SchemaWriter writer;
  fields(writer);
  return writer.schema();
}

}  // namespace

void read_fields(const std::filesystem::path& file, const std::string& text, const FieldList& fields) {
  read_object({file, "", parse_json(file, text)}, fields);
}

std::string json_schema(std::string_view title, std::string_view description, const FieldList& fields) {
  ordered_json schema{
      {"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}, {"description", description}};
  schema.update(schema_of(fields));
  return schema.dump(2) + '\n';
}

}  // namespace mssim
