#include "output/folders/provenance_file.h"

#include <nlohmann/json.hpp>

#include "tests/support/files_fixture.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using nlohmann::json;

/// A provenance in which no value is the default.
Provenance full_provenance() {
  Provenance provenance = made_up_provenance();
  provenance.machine.governor = "performance";
  provenance.machine.turbo = false;
  provenance.machine.smt = true;
  provenance.machine.numa_nodes = 2;
  provenance.machine.cpu_generation = "Zen 4";
  provenance.noise = {"turbo is on"};
  provenance.earlier_starts_utc = {"2026-01-30T12:00:00Z"};
  provenance.machine.memory_bytes = std::uint64_t{1} << 53;
  provenance.machine.cpu_quota = 1.5;
  provenance.machine.memory_limit_bytes = 5'000'000'000;
  provenance.machine.operating_system = "Some Linux";
  provenance.machine.kernel = "Linux 6";
  provenance.allowed_cpus = {0, 3};
  provenance.thread_environment = {{"GOMP_SPINCOUNT", "1"}, {"OMP_PLACES", "cores"}};
  provenance.opencl_devices = {"platform: device, driver 1"};
  provenance.tetgen = "1.5";
  provenance.program_fnv1a_64 = 0x123456789abcdef0;
  provenance.device_memory = "copy";
  provenance.roots = "exact";
  provenance.instruction_set = "AVX2";
  provenance.backend_programs = {
      {"mine.py", {"./mine.py"}, {{"./mine.py", 2}}},
      {"mpi", {"mssim-mpi"}, {{"mssim-mpi", 5}}, {{"A", "b"}, {"C", ""}}, 4, 2, "srun"},
      {"numba", {"python3", "numba.py", "-v"}, {{"numba.py", 0xfedcba9876543210}, {"python3", 3}}}};
  provenance.scenes = {{"cloth2500", 0xfedcba9876543210}, {"mine", 1, 0x1234}};
  return provenance;
}

json json_of(const Provenance& provenance) { return json::parse(provenance_text(provenance)); }

class ProvenanceFile : public TemporaryFolderTest {
 protected:
  /// The sentence that a file with this text is refused with, without its folder.
  std::string refusal_of(const std::string& text) const {
    const auto file = put("provenance.json", text);
    const std::string sentence = sentence_of<ProvenanceError>([&] { read_provenance(file); });
    EXPECT_THAT(sentence, AllOf(StartsWith(file.string() + ": "), Not(HasSubstr("\n")))) << text;
    return sentence.substr(std::min(sentence.size(), file.string().size() + 2));
  }

  /// The same for the full provenance with one value changed, or removed where it is discarded.
  std::string refusal_with(const std::string& pointer, const json& value) const {
    json document = json_of(full_provenance());
    const json::json_pointer place(pointer);
    if (value.is_discarded())
      document[place.parent_pointer()].erase(place.back());
    else
      document[place] = value;
    return refusal_of(document.dump());
  }
};

TEST_F(ProvenanceFile, ReadsBackWhatWasWritten) {
  const json written = json_of(full_provenance());
  EXPECT_EQ(json_of(read_provenance(put("a.json", written.dump(2)))), written);
  const json nearly_empty = json_of(Provenance{});
  EXPECT_EQ(json_of(read_provenance(put("b.json", nearly_empty.dump()))), nearly_empty);
  const json here = json_of(gather_provenance({"mssim", "bench"}, 2));
  EXPECT_EQ(json_of(read_provenance(put("c.json", here.dump()))), here);
}

TEST_F(ProvenanceFile, ReadsTheFilesUnderResults) {
  int read = 0;
  for (const auto& folder : std::filesystem::directory_iterator(source_file("results")))
    if (const auto file = folder.path() / "provenance.json"; exists(file)) {
      EXPECT_FALSE(read_provenance(file).scenes.empty()) << file;
      ++read;
    }
  EXPECT_GE(read, 1);
}

TEST_F(ProvenanceFile, MayHoldMoreThanIsKnownHere) {
  json document = json_of(full_provenance());
  document["new"] = document["cpu"]["new"] = {1, 2};
  EXPECT_EQ(json_of(read_provenance(put("new.json", document.dump()))), json_of(full_provenance()));
}

TEST_F(ProvenanceFile, OfALaterFormatIsRefused) {
  json document = json_of(full_provenance());
  EXPECT_EQ(document["format_version"], 1);
  EXPECT_THAT(refusal_with("/format_version", 2),
              AllOf(HasSubstr("/format_version is 2"), HasSubstr("up to 1"), HasSubstr("newer mssim")));
  EXPECT_THAT(refusal_with("/format_version", "1"), HasSubstr("/format_version is \"1\""));
}

TEST_F(ProvenanceFile, IsRefusedWithThePlaceAndTheValue) {
  EXPECT_EQ(refusal_with("/cpu/logical_cpus", "two"),
            "/cpu/logical_cpus is \"two\" instead of a whole number from 0 to 2147483647: give a "
            "provenance.json that mssim wrote");
  EXPECT_THAT(refusal_with("/cpu/logical_cpus", -1), HasSubstr("/cpu/logical_cpus is -1"));
  EXPECT_THAT(refusal_with("/cpu/logical_cpus", 2.5), HasSubstr("/cpu/logical_cpus is 2.5"));
  EXPECT_THAT(refusal_with("/threads/asked_for", 3000000000), HasSubstr("/threads/asked_for is 3000000000"));
  EXPECT_THAT(refusal_with("/threads/allowed_cpus/1", nullptr), HasSubstr("/threads/allowed_cpus/1 is null"));
  EXPECT_THAT(refusal_with("/threads/environment/OMP_PLACES", 1), HasSubstr("/OMP_PLACES is 1"));
  EXPECT_THAT(refusal_with("/threads/environment/A\x7F", 1), HasSubstr("/A\\u007f is 1"));
  EXPECT_THAT(refusal_with("/threads", json::array()), HasSubstr("/threads is [] instead of an object"));
  EXPECT_THAT(refusal_with("/build/dirty", "no"), HasSubstr("/build/dirty is \"no\" instead of true or"));
  EXPECT_THAT(refusal_with("/build/compiler", nullptr), HasSubstr("/build/compiler is null"));
  EXPECT_THAT(refusal_with("/opencl_devices", "none"), HasSubstr("instead of a list"));
  EXPECT_THAT(refusal_with("/cpu/turbo", 7), HasSubstr("/cpu/turbo is 7 instead of true or false"));
  EXPECT_THAT(refusal_with("/cpu/governor", 7), HasSubstr("/cpu/governor is 7"));
  EXPECT_THAT(refusal_with("/cpu/caches/0/bytes", 1e300), HasSubstr("/cpu/caches/0/bytes is 1e+300"));
  for (const char* hash : {"fedcba987654321", "fedcba987654321g", "0xfedcba98765432", "fedcba98765432100"})
    EXPECT_THAT(refusal_with("/scenes_fnv1a_64/mine", hash), HasSubstr("instead of 16 hexadecimal digits"));
  EXPECT_THAT(refusal_with("/backend_programs/numba/command/1", 7),
              HasSubstr("/backend_programs/numba/command/1 is 7 instead of a text"));
  EXPECT_THAT(refusal_of("[]"), HasSubstr("the document is [] instead of an object"));
}

/// The members that files of older versions do not have.
const std::vector<std::string> later_members{"/format_version",
                                             "/cpu/turbo",
                                             "/cpu/smt",
                                             "/cpu/numa_nodes",
                                             "/cpu/generation",
                                             "/cpu/cpu_quota",
                                             "/device_memory",
                                             "/roots",
                                             "/instruction_set",
                                             "/memory_limit_bytes",
                                             "/noise",
                                             "/program_fnv1a_64",
                                             "/earlier_starts_utc",
                                             "/backend_programs",
                                             "/scene_files_fnv1a_64"};

TEST_F(ProvenanceFile, WithoutOneOfItsValuesIsRefused) {
  const json gone(json::value_t::discarded);
  const json document = json_of(full_provenance());
  const json flat = document.flatten();
  int values = 0;
  for (const auto& [pointer, value] : flat.items()) {
    const json::json_pointer place(pointer);
    if (document[place.parent_pointer()].is_array() || pointer.starts_with("/scenes_fnv1a_64/") ||
        pointer.find("/environment/") != std::string::npos ||
        pointer.find("files_fnv1a_64/") != std::string::npos ||
        std::ranges::find(later_members, pointer) != later_members.end())
      continue;
    EXPECT_EQ(refusal_with(pointer, gone), pointer + " is missing: give a provenance.json that mssim wrote");
    ++values;
  }
  EXPECT_GT(values, 0);
}

TEST_F(ProvenanceFile, OfAnOlderMssimIsReadToo) {
  json document = json_of(full_provenance());
  for (const std::string& later : later_members) {
    const json::json_pointer place(later);
    document[place.parent_pointer()].erase(place.back());
  }
  const Provenance old = read_provenance(put("old.json", document.dump()));
  EXPECT_EQ(old.machine.turbo, std::nullopt);
  EXPECT_EQ(old.machine.smt, std::nullopt);
  EXPECT_EQ(old.machine.numa_nodes, 0);
  EXPECT_EQ(old.machine.cpu_generation, "");
  EXPECT_EQ(old.machine.cpu_quota, std::nullopt);
  EXPECT_EQ(old.machine.memory_limit_bytes, std::nullopt);
  EXPECT_EQ(old.program_fnv1a_64, std::nullopt);
  EXPECT_TRUE(old.noise.empty() && old.earlier_starts_utc.empty() && old.backend_programs.empty());
  EXPECT_EQ(old.scenes.back().files_fnv1a_64, std::nullopt);
  EXPECT_EQ(old.started_utc, full_provenance().started_utc);
}

TEST_F(ProvenanceFile, ThatIsNoJsonIsRefused) {
  EXPECT_THAT(refusal_of(""), HasSubstr("malformed JSON, parse error at line 1, column 1"));
  EXPECT_THAT(refusal_of("{\"build\": nan}"), HasSubstr("malformed JSON, parse error at line 1, column 12"));
  const std::string whole = json_of(full_provenance()).dump();
  EXPECT_THAT(refusal_of(whole.substr(0, whole.size() / 2)), HasSubstr("malformed JSON"));
  EXPECT_THAT(refusal_of("{\"memory_bytes\": 1e999}"), HasSubstr("malformed JSON, number overflow"));
  EXPECT_THAT(refusal_of("{\"cpu\": \"\xff\n\"}"), HasSubstr("malformed JSON"));
  EXPECT_THAT(refusal_of(std::string(1 << 16, '[')), HasSubstr("nested deeper than 32 levels"));
  EXPECT_THAT(refusal_of(std::string(largest_provenance_bytes + 1, ' ')), HasSubstr("longer than 256 KiB"));
}

}  // namespace
}  // namespace mssim
