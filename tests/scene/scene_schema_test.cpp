#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/fields/field_visitor.h"
#include "scene/scene_file.h"
#include "tests/support/scene_files.h"

namespace mssim {
namespace {

using nlohmann::json;

/// Writes the JSON Schema that the reader's own list of fields amounts to.
class SchemaWriter final : public FieldVisitor {
 public:
  SchemaWriter()
      : schema_{{"type", "object"},
                {"additionalProperties", false},
                {"required", json::array()},
                {"properties", json::object()}} {}

  void number(std::string_view key, double& /*target*/, const Range& range) override {
    add(key, Presence::required, number_schema("number", range));
  }
  void optional_number(std::string_view key, std::optional<double>& /*target*/, const Range& range) override {
    add(key, Presence::optional, number_schema("number", range));
  }
  void number_or_auto(std::string_view key, std::optional<double>& /*target*/, const Range& range) override {
    add(key, Presence::required, {{"oneOf", {number_schema("number", range), {{"const", "auto"}}}}});
  }
  void integer(std::string_view key, std::uint32_t& /*target*/, std::uint32_t minimum,
               std::uint32_t maximum) override {
    add(key, Presence::required, number_schema("integer", from(minimum, maximum)));
  }
  void text(std::string_view key, Presence presence, std::string& /*target*/) override {
    add(key, presence,
        {{"type", "string"}, {"maxLength", longest_text}, {"pattern", "^[^\\u0000-\\u001f]*$"}});
  }
  void vector(std::string_view key, Presence presence, Vec3d& /*target*/, const Range& each) override {
    add(key, presence,
        {{"type", "array"}, {"items", number_schema("number", each)}, {"minItems", 3}, {"maxItems", 3}});
  }
  void choice(std::string_view key, Presence presence, std::span<const std::string_view> words,
              std::uint32_t& /*target*/) override {
    add(key, presence, {{"type", "string"}, {"enum", words}});
  }
  void points(std::string_view key, std::size_t least, std::size_t most, const Range& each,
              std::vector<Vec3d>& /*target*/) override {
    const json point{
        {"type", "array"}, {"items", number_schema("number", each)}, {"minItems", 2}, {"maxItems", 2}};
    add(key, Presence::required,
        {{"type", "array"}, {"items", point}, {"minItems", least}, {"maxItems", most}});
  }
  void one_of(std::string_view key, std::span<const Section> sections) override {
    json names = json::array();
    for (const Section& section : sections) {
      names.push_back(section.name);
      object(section.name, Presence::optional, section.fields);
      const json present{{"required", {section.name}}};
      schema_["allOf"].push_back({{"if", {{"properties", {{key, {{"const", section.name}}}}}}},
                                  {"then", present},
                                  {"else", {{"not", present}}}});
    }
    add(key, Presence::required, {{"type", "string"}, {"enum", names}});
  }
  void list(std::string_view key, Presence presence, std::size_t most, const FieldList& element) override {
    SchemaWriter item;
    element(item);
    add(key, presence, {{"type", "array"}, {"minItems", 1}, {"maxItems", most}, {"items", item.schema()}});
  }
  void object(std::string_view key, Presence presence, const FieldList& fields) override {
    SchemaWriter nested;
    fields(nested);
    add(key, presence, nested.schema());
  }

  const json& schema() const { return schema_; }

 private:
  static json number_schema(const char* type, const Range& range) {
    return {{"type", type},
            {range.minimum_excluded ? "exclusiveMinimum" : "minimum", range.minimum},
            {"maximum", range.maximum}};
  }
  void add(std::string_view key, Presence presence, json schema) {
    EXPECT_FALSE(schema_["properties"].contains(std::string(key))) << key << " is named twice";
    schema_["properties"][std::string(key)] = std::move(schema);
    if (presence == Presence::required) schema_["required"].push_back(key);
  }

  json schema_;
};

/// Takes the words for people out of a schema, requiring each property to have some.
json without_words(json schema, const std::string& place) {
  EXPECT_TRUE(schema.contains("description") && schema["description"].is_string() &&
              schema["description"].get<std::string>().size() > 10)
      << place << " has no description";
  schema.erase("description");
  schema.erase("title");
  schema.erase("$schema");
  if (schema.contains("properties"))
    for (auto& [key, property] : schema["properties"].items()) property = without_words(property, key);
  if (schema.contains("items") && schema["items"].contains("properties"))
    schema["items"] = without_words(schema["items"], place + " element");
  return schema;
}

TEST(SceneSchema, SaysExactlyWhatTheReaderAccepts) {
  SceneSpec spec;
  SchemaWriter writer;
  visit_scene_fields(writer, spec);
  const json committed = json::parse(text_of(source_file("scenes/scene.schema.json")));
  EXPECT_EQ(committed.at("$schema"), "http://json-schema.org/draft-07/schema#");
  const json expected = writer.schema(), found = without_words(committed, "");
  EXPECT_EQ(found, expected) << "found instead of expected:\n" << json::diff(expected, found).dump(1);
}

TEST(SceneSchema, NamesTheUnitOfEveryFieldThatHasOne) {
  const json committed = json::parse(text_of(source_file("scenes/scene.schema.json")));
  const std::vector<std::pair<std::string, std::string>> units{
      {"_kg_per_m2", "kg/m^2"}, {"_kg_per_m3", "kg/m^3"}, {"_m3", "m^3"},      {"_rad_per_s", "rad/s"},
      {"_deg", "degrees"},      {"_n_s_per_m", "N s/m"},  {"_n_per_m", "N/m"}, {"_m_per_s2", "m/s^2"},
      {"_m_per_s", "m/s"},      {"_per_s", "1/s"},        {"_m", ", m"},       {"_s", ", s"}};
  int checked = 0;
  const std::function<void(const json&)> check = [&](const json& schema) {
    for (const auto& [key, property] : schema.at("properties").items()) {
      if (property.contains("properties")) check(property);
      if (property.contains("items") && property["items"].contains("properties")) check(property["items"]);
      const auto unit = std::find_if(
          units.begin(), units.end(),
          [&, name = std::string_view(key)](const auto& row) { return name.ends_with(row.first); });
      if (unit == units.end()) continue;
      ++checked;
      EXPECT_NE(property.at("description").get<std::string>().find(unit->second), std::string::npos) << key;
    }
  };
  check(committed);
  EXPECT_EQ(checked, 108);
}

}  // namespace
}  // namespace mssim
