#include <nlohmann/json.hpp>

#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

using nlohmann::json;

class SceneFile : public TemporaryFolderTest {
 protected:
  std::filesystem::path write(std::string_view text) const { return put(file().filename(), text); }
  std::filesystem::path file() const { return folder() / "bad.json"; }

  static std::string error_of(const std::filesystem::path& path) {
    return sentence_of<SceneError>([&] { load_scene(path); });
  }
};

const std::string good = read_file(source_file("scenes/cloth2500.json"));

TEST_F(SceneFile, GivesEveryFieldItsValue) {
  const SceneSpec spec = load_scene(source_file("scenes/cloth2500.json"));
  EXPECT_EQ(spec.name, "cloth2500");
  EXPECT_EQ(spec.source, good);
  EXPECT_THAT(spec.description, StartsWith("Cotton, 50 x 50 nodes"));
  ASSERT_TRUE(spec.dt_s);
  EXPECT_EQ(*spec.dt_s, 5e-5);
  EXPECT_EQ(spec.gravity_m_per_s2, 9.81);
  EXPECT_EQ(spec.viscous_damping_per_s, 0.1);
  EXPECT_EQ(spec.floor.height, 0);
  EXPECT_EQ(spec.floor.restitution, 0.3);
  EXPECT_EQ(spec.floor.friction, 0.4);
  const ClothSpec& cloth = std::get<ClothSpec>(spec.content);
  EXPECT_EQ(cloth.rows, 50U);
  EXPECT_EQ(cloth.columns, 50U);
  EXPECT_EQ(cloth.spacing_m, 0.01);
  EXPECT_EQ(cloth.areal_density_kg_per_m2, 0.2);
  EXPECT_EQ(cloth.ceiling_height_m, 0.441);
  ASSERT_TRUE(cloth.pins);
  EXPECT_EQ(cloth.pins->row, 0U);
  EXPECT_EQ(cloth.pins->every_columns, 10U);
  EXPECT_EQ(cloth.ripple.height_m, 0.0005);
  EXPECT_EQ(cloth.ripple.wavelength_m, 0.09);
  EXPECT_EQ(cloth.ripple.speed_m_per_s, 0.2);
  EXPECT_EQ(cloth.springs[structural].stiffness, 200);
  EXPECT_EQ(cloth.springs[structural].damping, 0.01);
  EXPECT_EQ(cloth.springs[shear].stiffness, 60);
  EXPECT_EQ(cloth.springs[shear].damping, 0.003);
  EXPECT_EQ(cloth.springs[bending].stiffness, 8);
  EXPECT_EQ(cloth.springs[bending].damping, 0.0004);
}

TEST_F(SceneFile, LeavesAnAutomaticDtEmpty) {
  EXPECT_FALSE(load_scene(write(with_change(good, "5e-5", "\"auto\""))).dt_s);
}

TEST_F(SceneFile, MayLeaveOutPinsAndSchema) {
  std::string text = with_change(good, R"("pins": {"row": 0, "every_columns": 10},)", "");
  text = with_change(text, R"("$schema": "scene.schema.json",)", "");
  EXPECT_FALSE(std::get<ClothSpec>(load_scene(write(text)).content).pins);
}

TEST_F(SceneFile, TakesWholeNumbersInAnyNotation) {
  EXPECT_EQ(
      std::get<ClothSpec>(load_scene(write(with_change(good, "\"rows\": 50", "\"rows\": 5e1"))).content).rows,
      50U);
}

/// A change to a good scene, and what its error names: place, value, remedy.
struct BadScene {
  const char *old_part, *new_part;
  const char *place, *value, *remedy;
};

const char* const rows = "\"rows\": 50";
const char* const dt = "\"dt_s\": 5e-5";
const std::string nested_lists = "\"rows\": " + std::string(100'000, '[');
const std::string nested_objects = [] {
  std::string text = "\"rows\": ";
  for (int i = 0; i < 100'000; ++i) text += "{\"a\":";
  return text;
}();
const std::string a_kind = [] {
  std::vector<std::string_view> names;
  for (const SceneKind* kind : scene_kinds()) names.push_back(kind->name);
  return "the text " + listed(names, "or");
}();
const std::string give_a_kind = "give " + a_kind, add_a_kind = "add it as " + a_kind;
const std::string long_words(201, 'w');
const std::string long_key = '"' + std::string(1'000'000, 'w') + R"(": 1, "rows": 50)";

const BadScene bad_scenes[]{
    // Numbers.
    {rows, "\"rows\": 1", "/cloth/rows", "is 1:", "give an integer from 2 to 1000000"},
    {rows, "\"rows\": 50.5", "/cloth/rows", "is 50.5", "give an integer"},
    {rows, "\"rows\": 99999999999999999999", "/cloth/rows", "is 1e+20", "give an integer"},
    {rows, "\"rows\": 4294967346", "/cloth/rows", "is 4294967346", "give an integer"},
    {dt, "\"dt_s\": 0", "/dt_s", "is 0", "a number from 1e-12 to 1, or \"auto\""},
    {dt, "\"dt_s\": 1.5", "/dt_s", "is 1.5", "from 1e-12 to 1"},
    {dt, "\"dt_s\": 1e999", "/dt_s", "is 1e999", "overflows to infinity: give a finite number"},
    {dt, "\"dt_s\": NaN", "/dt_s, line 5, column", "last read: '\"dt_s\": N'",
     "expected an object, a number"},
    {dt, "\"dt_s\": Infinity", "/dt_s, line 5, column", "last read: '\"dt_s\": I'", "a number"},
    {"9.81", "-9.81", "/gravity_m_per_s2", "is -9.81", "from 0 to 1000"},
    {"\"restitution\": 0.3", "\"restitution\": 1.01", "/floor/restitution", "is 1.01", "from 0 to 1"},
    {"200", "0", "/cloth/springs/structural/stiffness_n_per_m", "is 0", "above 0"},
    {"0.003", "-0.003", "/cloth/springs/shear/damping_n_s_per_m", "is -0.003", "from 0"},
    {"\"spacing_m\": 0.01", "\"spacing_m\": 0", "/cloth/spacing_m", "is 0", "from 1e-06 to 100"},
    // Types.
    {rows, "\"rows\": \"fifty\"", "/cloth/rows", "is the text \"fifty\"", "give an integer"},
    {rows, "\"rows\": true", "/cloth/rows", "is true", "give an integer"},
    {dt, "\"dt_s\": \"atuo\"", "/dt_s", "is the text \"atuo\"", "or \"auto\""},
    {dt, "\"dt_s\": {}", "/dt_s", "is an object", "a number"},
    {R"({"row": 0, "every_columns": 10})", "7", "/cloth/pins", "is 7", "give an object, { ... }"},
    {"\"cloth\",", "5,", "/kind", "is 5", give_a_kind.c_str()},
    {"\"cloth\",", "\"clot\",", "/kind", "is the text \"clot\"", give_a_kind.c_str()},
    {"Cotton", "Cot\\nton", "/description", "is the text \"Cot\\nton", "one line of text"},
    {"Cotton", long_words.c_str(), "/description", "is the text \"www", "at most 200 characters"},
    // Keys.
    {"\"rows\"", "\"row\"", "/cloth/row ", "value is 50", "did you mean \"rows\"?"},
    {"\"kind\"", "\"knid\"", "/knid ", "value is the text \"cloth\"", "did you mean \"kind\"?"},
    {rows, "\"rows\": 50, \"density\": [1]", "/cloth/density ", "value is a list",
     "known here are rows, columns, spacing_m, areal_density_kg_per_m2, ceiling_height_m, pins, ripple and "
     "springs"},
    {rows, "\"rows\": 50, \"a/b~c\\n\": 1", "/cloth/a~1b~0c\\n ", "value is 1", "known here are"},
    {rows, long_key.c_str(), "/cloth/www", "value is 1", "known here are"},
    {"\"rows\": 50,", "", "/cloth/rows", "is missing", "add it as an integer from 2 to 1000000"},
    {"\"kind\": \"cloth\",", "", "/kind", "is missing", add_a_kind.c_str()},
    {rows, "\"rows\": 50, \"rows\": 60", "/cloth/rows", "is given twice", "keep one of the two"},
    // Syntax.
    {"\"rows\": 50,", "\"rows\": 50", "/cloth/rows, line 11, column 13", "unexpected string literal",
     "expected ',' or '}'"},
    {"\"rows\"", "rows", "/cloth, line 10, column 5", "last read: ", "expected string literal"},
    {"\"rows\":", "\"rows\"", "/cloth/rows, line 10, column", "unexpected number literal", "expected ':'"},
    {"\"kind\"", "// the kind\n\"kind\"", "line 3, column", "last read: ", "correct the file there"},
    {"Cotton", "Cot\xfften", "/description, line 4, column", "ill-formed UTF-8", "correct the file there"},
    {rows, nested_lists.c_str(), "/cloth/rows/0/0/0", "deeper than 32 levels", "remove the surplus"},
    {rows, nested_objects.c_str(), "/cloth/rows/a/a/a", "deeper than 32 levels", "remove the surplus"},
    // Fields together.
    {"\"row\": 0", "\"row\": 50", "/cloth/pins/row", "is 50", "numbered from 0 to 49: name one of them"},
    {"0.441", "0.0004", "/cloth/ceiling_height_m", "is 0.0004", "raise it or lower /floor/height_m"},
    {"0.0005", "0.0095", "/cloth/ripple/height_m", "is 0.0095", "give at most 0.009"},
    {"\"height_m\": 0.0005, \"wavelength_m\": 0.09", "\"height_m\": 0.011, \"wavelength_m\": 0.9",
     "/cloth/ripple/height_m", "is 0.011", "give at most 0.01 or remove /cloth/pins"},
    {"\"rows\": 50,\n    \"columns\": 50", "\"rows\": 65536,\n    \"columns\": 65536", "/cloth/rows",
     "is 65536, which with 65536 columns makes 4294967296 nodes", "at or below 4294967295"}};

TEST_F(SceneFile, ThatIsBrokenIsRefusedInOneSentenceWithFilePlaceValueAndRemedy) {
  for (const BadScene& bad : bad_scenes) {
    SCOPED_TRACE(std::string_view(bad.new_part).substr(0, 60));
    const std::string error = error_of(write(with_change(good, bad.old_part, bad.new_part)));
    EXPECT_THAT(error, StartsWith(file().string() + ": "));
    EXPECT_THAT(error, AllOf(HasSubstr(bad.place), HasSubstr(bad.value), HasSubstr(bad.remedy),
                             Not(HasSubstr("\n")), Not(HasSubstr("[json.exception"))));
    EXPECT_LT(error.size(), 700U);
  }
}

TEST_F(SceneFile, ThatIsMissingOrNoFileIsNamed) {
  EXPECT_THAT(error_of(folder() / "none.json"),
              AllOf(StartsWith((folder() / "none.json").string()), HasSubstr("no such file"),
                    HasSubstr("check the path")));
  EXPECT_THAT(error_of(folder()), HasSubstr("is not a regular file: give"));
}

TEST_F(SceneFile, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(load_scene(write("\xef\xbb\xbf" + good)).description, load_scene(write(good)).description);
}

TEST_F(SceneFile, ThatIsEmptyOrBlankIsRefused) {
  EXPECT_THAT(error_of(write("")), HasSubstr("is empty: give a scene file"));
  EXPECT_THAT(error_of(write(" \n")),
              AllOf(HasSubstr("line 2"), HasSubstr("unexpected end of input; expected")));
}

TEST_F(SceneFile, ThatIsTooLongIsNotReadToItsEnd) {
  EXPECT_THAT(error_of(write('"' + std::string(largest_scene_bytes, 'x') + '"')),
              AllOf(HasSubstr("is longer than 16 MiB"), HasSubstr("give a scene file")));
}

TEST_F(SceneFile, CutShortAnywhereIsRefusedWithoutACrash) {
  const std::size_t end = good.rfind('}');
  for (std::size_t length = 1; length <= end; ++length)
    EXPECT_THAT(error_of(write(good.substr(0, length))), HasSubstr("malformed JSON")) << length;
  for (const std::string& rest : {std::string("{}"), std::string(1, '\0'), '\0' + good})
    EXPECT_THAT(error_of(write(good + rest)), HasSubstr("malformed JSON")) << rest;
}

TEST(SpringConstant, ThatIsNotRequiredIsZeroUnlessAFileStatesIt) {
  SpringConstantInfo constant = spring_constants.back();
  constant.required = false;
  SpringMaterial material;
  const FieldList fields = [&](FieldVisitor& visitor) {
    visit_constant(visitor, constant, material, from(0, constant.most));
  };
  read_fields("scene", fmt::format(R"({{"{}": 0.5}})", constant.key), fields);
  EXPECT_EQ(material.*constant.number, 0.5);
  read_fields("scene", "{}", fields);
  EXPECT_EQ(material.*constant.number, 0);
  EXPECT_THAT(json_schema("", "", fields), HasSubstr(R"("required": [])"));
  constant.required = true;
  EXPECT_THROW(read_fields("scene", "{}", fields), SceneError);
}

TEST(SceneNames, AreTheCommittedOnesByKindAndSize) {
  std::vector<std::string> names;
  for (const SceneSpec& spec : shipped_scenes()) names.push_back(spec.name);
  EXPECT_THAT(names,
              ElementsAre("cloth2500", "cloth4900", "cloth10k", "cloth10k-x2", "cloth10k-x4", "cloth40k",
                          "cloth10k-x8", "cloth200k", "cloth350k", "cloth350k-x2", "cloth1m", "cloth350k-x4",
                          "cloth350k-x8", "cloth4m", "cloth16m", "torus-small", "box-small", "sphere-small",
                          "torus-medium", "box-medium", "sphere-medium", "torus-large", "box-large",
                          "sphere-large", "bodies3858", "bodies4737", "bodies7282", "bodies10223",
                          "bodies20587", "bodies38233", "jeans1k", "jeans2k", "skirt", "jeans4k",
                          "jeans4k-hip88", "jeans4k-hip115", "outfit", "jeans8k", "jeans16k", "jeans64k"));
}

TEST(FindScene, FindsByNameAndByPath) {
  EXPECT_EQ(find_scene("cloth10k").name, "cloth10k");
  EXPECT_EQ(find_scene(source_file("scenes/cloth10k.json").string()).source, find_scene("cloth10k").source);
}

TEST(FindScene, SaysWhatAnUnknownNameMayMean) {
  for (const auto& [name, hint] :
       std::vector<std::pair<std::string, std::string>>{{"cloth35k", "did you mean cloth350k?"},
                                                        {"cloth25", "did you mean cloth2500?"},
                                                        {"CLOTH2500", "did you mean cloth2500?"},
                                                        {"teapot", "no scene is named \"teapot\": give"},
                                                        {"", "no scene is named \"\""},
                                                        {"scene.schema", "no scene is named"},
                                                        {"..", "no scene is named"}}) {
    EXPECT_THAT(sentence_of<SceneError>([&wrong = name] { find_scene(wrong); }),
                AllOf(HasSubstr(hint), HasSubstr("mssim list scenes")));
  }
}

TEST_F(SceneFile, OfMegabytesIsRefusedInSecondsNotHours) {
  // The parser used to go through the whole list after each of its elements.
  std::string text = "[";
  for (int i = 0; i < 500'000; ++i) text += "{},";
  EXPECT_THAT(error_of(write(text + "0]")), HasSubstr("the top level is a list: give an object"));
}

TEST(NearestName, CountsInsertionsDeletionsReplacementsAndSwaps) {
  const std::vector<std::string_view> names{"rows", "columns", "spacing_m"};
  EXPECT_EQ(nearest_name("rosw", names), "rows");
  EXPECT_EQ(nearest_name("column", names), "columns");
  EXPECT_EQ(nearest_name("spacing", names), "spacing_m");
  EXPECT_EQ(nearest_name("colums", names), "columns");
  EXPECT_EQ(nearest_name("colum", names), "columns");
  EXPECT_EQ(nearest_name("colu", names), "") << "more than a third of it is missing";
  EXPECT_EQ(nearest_name("gravity", names), "");
  EXPECT_EQ(nearest_name("", names), "");
}

TEST(UnknownName, IsComplainedOfWithTheNearestAndTheKnown) {
  const std::vector<std::string_view> names{"serial", "openmp", "opencl"};
  EXPECT_EQ(unknown_name("backend", "openpm", names),
            "unknown backend \"openpm\" (did you mean openmp?): known are serial, openmp and opencl");
  EXPECT_EQ(unknown_name("backend", "cuda\n", names),
            "unknown backend \"cuda\\n\": known are serial, openmp and opencl");
}

TEST(DidYouMean, OffersNamesThatShareAWordOrABeginning) {
  const std::vector<std::string_view> names{"semi-euler", "explicit-euler", "threads-mutex", "--out", "rk4"};
  EXPECT_EQ(did_you_mean("euler", names), " (did you mean semi-euler or explicit-euler?)");
  EXPECT_EQ(did_you_mean("threads", names), " (did you mean threads-mutex?)");
  EXPECT_EQ(did_you_mean("--output", names), " (did you mean --out?)");
  EXPECT_EQ(did_you_mean("rk45-of-mine", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
}

TEST(DidYouMean, OffersNoMoreThanFour) {
  const std::vector<std::string_view> names{"cloth-of-wool", "cloth-of-silk", "cloth-of-hemp",
                                            "cloth-of-flax", "cloth-of-jute"};
  EXPECT_EQ(did_you_mean("cloth", names), "");
}

TEST(DidYouMean, KnowsOtherNames) {
  const std::vector<std::string_view> names{"serial", "opencl"};
  const std::vector<OtherName> others{{"gpu", "opencl"}};
  EXPECT_EQ(did_you_mean("GPU", names, others), " (did you mean opencl?)");
}

/// Checks an object's description and those of all its fields.
void check_descriptions(const json& object, const std::string& place) {
  EXPECT_GT(object.value("description", std::string()).size(), 10U) << place;
  for (const auto& [key, field] : object.at("properties").items()) {
    EXPECT_GT(field.value("description", std::string()).size(), 10U) << place << '/' << key;
    const json& nested = field.contains("items") ? field["items"] : field;
    if (nested.contains("properties")) check_descriptions(nested, place + '/' + key);
  }
}

TEST(SceneSchema, DescribesEveryField) { check_descriptions(json::parse(scene_schema()), ""); }

}  // namespace
}  // namespace mssim
