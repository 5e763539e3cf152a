#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec3.h"

namespace mssim {

class FieldVisitor;

/// Names the fields of one JSON object, each once, to whoever visits: the reader fills them from a file, the
/// schema test compares them with the published schema. Such a list is the only place that knows a scene
/// file's keys.
using FieldList = std::function<void(FieldVisitor&)>;

/// What a number in a scene file may be. The unit is part of the key.
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
  std::string_view name;
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

  virtual void number(std::string_view key, double& target, const Range& range) = 0;
  virtual void optional_number(std::string_view key, std::optional<double>& target, const Range& range) = 0;
  /// A number, or the text "auto", which leaves the target empty.
  virtual void number_or_auto(std::string_view key, std::optional<double>& target, const Range& range) = 0;
  virtual void integer(std::string_view key, std::uint32_t& target, std::uint32_t minimum,
                       std::uint32_t maximum) = 0;
  /// One line of at most `longest_text` characters.
  virtual void text(std::string_view key, Presence presence, std::string& target) = 0;
  /// One of several words, of which the target becomes the number.
  virtual void choice(std::string_view key, Presence presence, std::span<const std::string_view> words,
                      std::uint32_t& target) = 0;
  /// Three numbers, [x, y, z].
  virtual void vector(std::string_view key, Presence presence, Vec3d& target, const Range& each) = 0;
  /// A list of `least` to `most` points of a plane, each two numbers, [x, y]; z becomes 0.
  virtual void points(std::string_view key, std::size_t least, std::size_t most, const Range& each,
                      std::vector<Vec3d>& target) = 0;
  /// One of several sections: the text at `key` names it, and the object of that name holds it.
  virtual void one_of(std::string_view key, std::span<const Section> sections) = 0;
  /// A list of 1 to `most` objects; `element` is called for each of them, or once where there is no file.
  virtual void list(std::string_view key, Presence presence, std::size_t most, const FieldList& element) = 0;
  /// A nested object; `fields` is called only when it is there.
  virtual void object(std::string_view key, Presence presence, const FieldList& fields) = 0;
};

}  // namespace mssim
