#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/fields/fields.h"

namespace mssim {
namespace {

using nlohmann::ordered_json;

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

ordered_json words(std::span<const std::string_view> known) { return {{"type", "string"}, {"enum", known}}; }

ordered_json one_text(std::size_t longest = longest_text) {
  return {{"type", "string"}, {"maxLength", longest}, {"pattern", "^[^\\u0000-\\u001f]*$"}};
}

/// Describes one object.
class SchemaWriter final : public FieldVisitor {
 public:
  explicit SchemaWriter(const FieldList& fields) { fields(*this); }

  void number(const Field& field, double& /*target*/, const Range& range) override {
    add(field, Presence::required, numbers("number", range));
  }
  void optional_number(const Field& field, std::optional<double>& /*target*/, const Range& range) override {
    add(field, Presence::optional, numbers("number", range));
  }
  void number_or_auto(const Field& field, std::optional<double>& /*target*/, const Range& range) override {
    add(field, Presence::required, {{"oneOf", {numbers("number", range), {{"const", "auto"}}}}});
  }
  void integer(const Field& field, std::uint32_t& /*target*/, std::uint32_t minimum,
               std::uint32_t maximum) override {
    add(field, Presence::required, numbers("integer", from(minimum, maximum)));
  }
  void text(const Field& field, Presence presence, std::string& /*target*/) override {
    add(field, presence, one_text());
  }
  void texts(const Field& field, Presence presence, std::size_t least, std::size_t most, std::size_t longest,
             std::vector<std::string>& /*target*/) override {
    add(field, presence, array_of(one_text(longest), least, most));
  }
  void named_texts(const Field& field, std::size_t most, std::size_t longest,
                   std::vector<std::pair<std::string, std::string>>& /*target*/) override {
    add(field, Presence::optional,
        {{"type", "object"}, {"maxProperties", most}, {"additionalProperties", one_text(longest)}});
  }
  void choice(const Field& field, Presence presence, std::span<const std::string_view> known,
              std::uint32_t& /*target*/) override {
    add(field, presence, words(known));
  }
  void vector(const Field& field, Presence presence, Vec3d& /*target*/, const Range& each) override {
    add(field, presence, array_of(numbers("number", each), 3, 3));
  }
  void points(const Field& field, std::size_t least, std::size_t most, const Range& each,
              std::vector<Vec3d>& /*target*/) override {
    add(field, Presence::required, array_of(array_of(numbers("number", each), 2, 2), least, most));
  }
  void one_of(const Field& field, std::span<const Section> sections) override {
    std::vector<std::string_view> names;
    for (const Section& section : sections) names.push_back(section.field.key);
    add(field, Presence::required, words(names));
    for (const Section& section : sections) {
      object(section.field, Presence::optional, section.fields);
      const ordered_json present{{"required", {section.field.key}}};
      conditions_.push_back({{"if", {{"properties", {{field.key, {{"const", section.field.key}}}}}}},
                             {"then", present},
                             {"else", {{"not", present}}}});
    }
  }
  void list(const Field& field, Presence presence, std::size_t most, std::string_view description,
            const FieldList& fields) override {
    ordered_json element{{"description", description}};
    element.update(SchemaWriter(fields).schema());
    add(field, presence, array_of(std::move(element), 1, most));
  }
  void object(const Field& field, Presence presence, const FieldList& fields) override {
    add(field, presence, SchemaWriter(fields).schema());
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
  void add(const Field& field, Presence presence, const ordered_json& schema) {
    ordered_json& property = properties_[std::string(field.key)];
    property = {{"description", field.description}};
    property.update(schema);
    if (presence == Presence::required) required_.push_back(field.key);
  }

  ordered_json required_ = ordered_json::array(), properties_ = ordered_json::object(),
               conditions_ = ordered_json::array();
};

}  // namespace

std::string json_schema(std::string_view title, std::string_view description, const FieldList& fields) {
  ordered_json schema{
      {"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}, {"description", description}};
  schema.update(SchemaWriter(fields).schema());
  return schema.dump(2) + '\n';
}

}  // namespace mssim
