#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
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
struct FieldValue;
struct PlacedJson;

/// Names the fields of one JSON object, each once, to a visitor: the reader sets their targets from a file,
/// the schema writer describes them. A program that writes a scene file names its keys again.
using FieldList = std::function<void(FieldVisitor&)>;

/// A field's key, which ends in its unit, and its description in the schema, which states the unit.
struct Field {
  std::string_view key;
  std::string_view description;
};

/// Allowed range of a number in a scene file.
struct Range {
  double minimum = 0;
  bool minimum_excluded = false;
  double maximum = 0;
};
/// Ranges up to `maximum`: with `minimum`, and without it.
constexpr Range from(double minimum, double maximum) { return {minimum, false, maximum}; }
constexpr Range above(double minimum, double maximum) { return {minimum, true, maximum}; }

/// Whether a field may be missing.
enum class Presence { required, optional };

/// One of several alternative sections of an object.
struct Section {
  Field field;
  FieldList fields;
};

/// Longest text of a scene file, in characters; that of a field with a limit of its own may be longer.
inline constexpr std::size_t longest_text = 200;

/// Visits the fields of one JSON object. Fields not marked optional are required; keys that are not visited
/// are errors.
class FieldVisitor {
 public:
  FieldVisitor() = default;
  FieldVisitor(const FieldVisitor&) = delete;
  FieldVisitor& operator=(const FieldVisitor&) = delete;
  virtual ~FieldVisitor() = default;

  void number(const Field& field, double& target, const Range& range);
  void optional_number(const Field& field, std::optional<double>& target, const Range& range);
  /// A number, or the text "auto", which leaves the target empty.
  void number_or_auto(const Field& field, std::optional<double>& target, const Range& range);
  void integer(const Field& field, std::uint32_t& target, std::uint32_t minimum, std::uint32_t maximum);
  /// One line of at most `longest_text` characters.
  void text(const Field& field, Presence presence, std::string& target);
  /// A required list of 1 to `most` lines of at most `longest` characters.
  void texts(const Field& field, std::size_t most, std::size_t longest, std::vector<std::string>& target);
  /// An object of at most `most` such lines, with arbitrary keys.
  void named_texts(const Field& field, std::size_t most, std::size_t longest,
                   std::vector<std::pair<std::string, std::string>>& target);
  /// One of several words; the target becomes its index.
  void choice(const Field& field, Presence presence, std::span<const std::string_view> words,
              std::uint32_t& target);
  /// An optional list of at least one of several words.
  void choices(const Field& field, std::span<const std::string_view> words, std::vector<std::string>& target);
  /// Three numbers, [x, y, z].
  void vector(const Field& field, Presence presence, Vec3d& target, const Range& each);
  /// A list of `least` to `most` points of a plane, each two numbers, [x, y]; z becomes 0.
  void points(const Field& field, std::size_t least, std::size_t most, const Range& each,
              std::vector<Vec3d>& target);
  /// One of several sections: the field's text names it, and the object of that name contains it.
  virtual void one_of(const Field& field, std::span<const Section> sections) = 0;
  /// A list of 1 to `most` objects. `description` describes one object; `fields` is called for each, or once
  /// if there is no file.
  void list(const Field& field, Presence presence, std::size_t most, std::string_view description,
            const FieldList& fields);
  /// A nested object; `fields` is called only if it is present.
  void object(const Field& field, Presence presence, const FieldList& fields);

 private:
  /// Any field: `take` assigns the value of a file.
  virtual void visit(const Field& field, Presence presence, const FieldValue& value,
                     const std::function<void(const PlacedJson& found)>& take) = 0;
};

/// One of several words; the target, an enumeration or a bool, becomes its index.
template <class Value>
void visit_choice(FieldVisitor& fields, const Field& field, Presence presence,
                  std::span<const std::string_view> words, Value& target) {
  auto number = static_cast<std::uint32_t>(target);
  fields.choice(field, presence, words, number);
  target = static_cast<Value>(number);
}

static_assert(spring_constants.front().number == &SpringMaterial::stiffness);
inline constexpr double largest_stiffness = spring_constants.front().most;  ///< N/m

/// Names the field of a constant of springs, with its target in `material`.
inline void visit_constant(FieldVisitor& fields, const SpringConstantInfo& constant, SpringMaterial& material,
                           const Range& range) {
  const Field field{constant.key, constant.sentence};
  if (constant.required) return fields.number(field, material.*constant.number, range);
  std::optional<double> stated;
  fields.optional_number(field, stated, range);
  material.*constant.number = stated.value_or(0);
}

/// Names the fields of one kind of spring, with their targets in `material`.
inline void visit_material(FieldVisitor& fields, SpringMaterial& material, const Range& stiffness) {
  for (const SpringConstantInfo& constant : spring_constants)
    visit_constant(fields, constant, material,
                   constant.number == &SpringMaterial::stiffness ? stiffness : from(0, constant.most));
}

/// Bad input: a scene that cannot be found, read, parsed or built. what() is one sentence with the file, the
/// place in it (a JSON pointer such as /cloth/rows), the value and the remedy. Commands print it and exit
/// with 2.
struct SceneError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Throws SceneError: "FILE: POINTER PROBLEM".
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view pointer,
                         const std::string& problem);

/// Throws SceneError: "FILE: POINTER PROBLEM: " and the error's sentence.
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view pointer,
                         std::string_view problem, const std::exception& error);

/// What `act` returns; if it throws a Failure, refuses the place in the file with that error.
template <class Failure, class Act>
auto refusing(const std::filesystem::path& file, std::string_view pointer, std::string_view problem,
              const Act& act) {
  try {
    return act();
  } catch (const Failure& error) {
    refuse(file, pointer, problem, error);
  }
}

/// A number for an error message, in the fewest digits that read back as the same number.
std::string shown_number(double number);

/// The height of the floor that a scene file states, m; nothing if it states none, or if `scene_json` is not
/// a scene file.
std::optional<double> stated_floor(const std::string& scene_json);

/// Assigns the values of a JSON text to the fields, recursively. `file` is the source of the text. Throws
/// SceneError, one sentence with file, JSON pointer, value and remedy, for text that is not strict JSON
/// (parse_json), a document that is not an object, an unknown key (naming the nearest known one), a missing
/// key, a wrong type, a fraction instead of an integer, and a number out of range.
void read_fields(const std::filesystem::path& file, const std::string& text, const FieldList& fields);

/// The JSON Schema (draft 7) of files whose top object has these fields: it accepts what read_fields accepts.
/// `title` and `description` describe the file. Indented, ends with a newline.
std::string json_schema(std::string_view title, std::string_view description, const FieldList& fields);

}  // namespace mssim
