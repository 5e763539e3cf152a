#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/vec3.h"
#include "model/system.h"
#include "text/error.h"

namespace mssim {

class FieldVisitor;

/// Names the fields of one JSON object, each once, to whoever visits: the reader fills them from a file, the
/// schema describes them. Such a list is the only place that knows a scene file's keys.
using FieldList = std::function<void(FieldVisitor&)>;

/// A field's key, which ends in its unit, and its description in the schema, which states the unit.
struct Field {
  std::string_view key;
  std::string_view description;
};

/// What a number in a scene file may be.
struct Range {
  double minimum = 0;
  bool minimum_excluded = false;
  double maximum = 0;
};
constexpr Range from(double minimum, double maximum) { return {minimum, false, maximum}; }
constexpr Range above(double minimum, double maximum) { return {minimum, true, maximum}; }

enum class Presence { required, optional };

/// A section that an object may have instead of others.
struct Section {
  Field field;
  FieldList fields;
};

/// Longest text of a scene file, in characters.
inline constexpr std::size_t longest_text = 200;

/// Is told the fields of one JSON object. What is not marked optional must be there; keys that no call names
/// are not allowed.
class FieldVisitor {
 public:
  FieldVisitor() = default;
  FieldVisitor(const FieldVisitor&) = delete;
  FieldVisitor& operator=(const FieldVisitor&) = delete;
  virtual ~FieldVisitor() = default;

  virtual void number(const Field& field, double& target, const Range& range) = 0;
  virtual void optional_number(const Field& field, std::optional<double>& target, const Range& range) = 0;
  /// A number, or the text "auto", which leaves the target empty.
  virtual void number_or_auto(const Field& field, std::optional<double>& target, const Range& range) = 0;
  virtual void integer(const Field& field, std::uint32_t& target, std::uint32_t minimum,
                       std::uint32_t maximum) = 0;
  /// One line of at most `longest_text` characters.
  virtual void text(const Field& field, Presence presence, std::string& target) = 0;
  /// A list of `least` to `most` such texts.
  virtual void texts(const Field& field, Presence presence, std::size_t least, std::size_t most,
                     std::vector<std::string>& target) = 0;
  /// An object of at most `most` such texts, whose keys may be any.
  virtual void named_texts(const Field& field, std::size_t most,
                           std::vector<std::pair<std::string, std::string>>& target) = 0;
  /// One of several words, of which the target becomes the number.
  virtual void choice(const Field& field, Presence presence, std::span<const std::string_view> words,
                      std::uint32_t& target) = 0;
  /// Three numbers, [x, y, z].
  virtual void vector(const Field& field, Presence presence, Vec3d& target, const Range& each) = 0;
  /// A list of `least` to `most` points of a plane, each two numbers, [x, y]; z becomes 0.
  virtual void points(const Field& field, std::size_t least, std::size_t most, const Range& each,
                      std::vector<Vec3d>& target) = 0;
  /// One of several sections: the text of the field names it, and the object of that name holds it.
  virtual void one_of(const Field& field, std::span<const Section> sections) = 0;
  /// A list of 1 to `most` objects. `description` is of one of them; `fields` is called for each of them, or
  /// once where there is no file.
  virtual void list(const Field& field, Presence presence, std::size_t most, std::string_view description,
                    const FieldList& fields) = 0;
  /// A nested object; `fields` is called only when it is there.
  virtual void object(const Field& field, Presence presence, const FieldList& fields) = 0;
};

/// One of several words, of which the target, an enumeration or a truth, becomes the number.
template <class Value>
void visit_choice(FieldVisitor& fields, const Field& field, Presence presence,
                  std::span<const std::string_view> words, Value& target) {
  auto number = static_cast<std::uint32_t>(target);
  fields.choice(field, presence, words, number);
  target = static_cast<Value>(number);
}

/// No length of a garment or its body is larger, m.
inline constexpr double largest_length_m = 10;

/// A length of a garment or its body.
inline void visit_length(FieldVisitor& fields, const Field& field, double& target) {
  fields.number(field, target, above(0, largest_length_m));
}

inline constexpr double largest_stiffness = spring_constants.front().most;  ///< N/m

/// Names the fields of one kind of spring, with their targets in `material`.
inline void visit_material(FieldVisitor& fields, SpringMaterial& material, const Range& stiffness) {
  for (const SpringConstantInfo& constant : spring_constants)
    fields.number({constant.key, constant.sentence}, material.*constant.number,
                  constant.number == &SpringMaterial::stiffness ? stiffness : from(0, constant.most));
}

/// Bad input: a scene that cannot be found, read, understood or built. what() is one sentence that names the
/// file, the place in it (a JSON pointer such as /cloth/rows), the value and the remedy. Commands print it
/// and exit with 2.
struct SceneError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Throws SceneError: "FILE: POINTER PROBLEM".
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view pointer,
                         const std::string& problem);

/// A number for an error message, as short as it reads back.
std::string shown_number(double number);

/// The height of the floor that a scene file states, m; none where it states none, or where `scene_json` is
/// no scene file.
std::optional<double> stated_floor(const std::string& scene_json);

/// Gives every value of a JSON text's top object to its field, recursively. `file` is where the text came
/// from. Throws SceneError, one sentence with file, JSON pointer, value and remedy, for what is not strict
/// JSON (parse_json), a document that is no object, an unknown key (naming the nearest known one), a missing
/// key, a wrong type, a fraction where an integer is asked for, and a number out of its range.
void read_fields(const std::filesystem::path& file, const std::string& text, const FieldList& fields);

/// The JSON Schema (draft 7) of a file whose top object has these fields: it accepts what read_fields
/// accepts. `title` and `description` are of the file. Indented, ends with a newline.
std::string json_schema(std::string_view title, std::string_view description, const FieldList& fields);

}  // namespace mssim
