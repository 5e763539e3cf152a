#include "output/folders/provenance_file.h"

#include <array>
#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "platform/files.h"
#include "text/text.h"

namespace mssim {
namespace {

using nlohmann::json;

/// A provenance has four levels; printing a value recurses.
constexpr int deepest_level = 32;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) {
  throw ProvenanceError("{}: {}", file.string(), problem);
}

json caches_json(const std::vector<Cache>& caches) {
  json list = json::array();
  for (const Cache& cache : caches)
    list.push_back({{"level", cache.level},
                    {"type", cache.type},
                    {"bytes", cache.bytes},
                    {"count", cache.count},
                    {"logical_cpus_sharing", cache.sharing}});
  return list;
}

/// Members that are a text, or null if it is empty; older versions do not have all.
struct SettingMember {
  const char* name;
  std::string Provenance::*value;
};
constexpr std::array<SettingMember, 3> setting_members{{{"device_memory", &Provenance::device_memory},
                                                        {"instruction_set", &Provenance::instruction_set},
                                                        {"roots", &Provenance::roots}}};

/// A value of the document and its place: the root is the file, a member is reached by its key.
class Place {
 public:
  Place(const std::filesystem::path& file, const json& root) : file_(file), value_(root) {}

  Place operator[](const std::string& key) const {
    const std::optional<Place> member = find(key);
    if (!member) fail(file_, pointer_ + '/' + key + " is missing: give a provenance.json that mssim wrote");
    return *member;
  }
  /// None if there is no such member, as in files of older versions.
  std::optional<Place> find(const std::string& key) const {
    require(value_.is_object(), "an object");
    const auto member = value_.find(key);
    if (member == value_.end()) return std::nullopt;
    return Place(file_, *member, pointer_ + '/' + key);
  }

  /// None if there is no such member, or it is null: unknown.
  std::optional<Place> known(const std::string& key) const {
    const auto member = find(key);
    return member && !member->value_.is_null() ? member : std::nullopt;
  }

  std::string text() const {
    require(value_.is_string(), "a text");
    return value_.get<std::string>();
  }
  bool is_null() const { return value_.is_null(); }
  bool truth() const {
    require(value_.is_boolean(), "true or false");
    return value_.get<bool>();
  }
  double number() const {
    require(value_.is_number(), "a number");
    return value_.get<double>();
  }
  template <std::integral Number>
  Number count() const {
    // The library takes a whole number without a sign as unsigned.
    require(value_.is_number_unsigned() && std::in_range<Number>(value_.get<std::uint64_t>()),
            fmt::format("a whole number from 0 to {}", std::numeric_limits<Number>::max()));
    return value_.get<Number>();
  }
  /// Throws LaterFormatError if the document states a later format than `newest`.
  void require_format(int newest) const {
    const auto version = find("format_version");
    if (version && version->count<int>() > newest)
      throw LaterFormatError(
          "{}: /format_version is {}, and this mssim reads versions up to {}: use a newer mssim",
          file_.string(), version->count<int>(), newest);
  }
  /// 16 hexadecimal digits, as to_hex() writes them.
  std::uint64_t hash() const {
    const auto number = from_hex(value_.is_string() ? value_.get<std::string>() : std::string());
    require(number.has_value(), "16 hexadecimal digits");
    return *number;
  }
  /// The results of `read` for each element of a list.
  template <class Read>
  auto list(Read read) const {
    require(value_.is_array(), "a list");
    std::vector<decltype(read(*this))> elements;
    for (std::size_t i = 0; i < value_.size(); ++i)
      elements.push_back(read(Place(file_, value_[i], fmt::format("{}/{}", pointer_, i))));
    return elements;
  }
  /// The results of `read` for each name and value of an object.
  template <class Read>
  auto members(Read read) const {
    require(value_.is_object(), "an object");
    std::vector<decltype(read(std::string(), *this))> elements;
    for (const auto& [name, value] : value_.items())
      elements.push_back(read(name, Place(file_, value, pointer_ + '/' + printable(name))));
    return elements;
  }

 private:
  Place(const std::filesystem::path& file, const json& value, std::string pointer)
      : file_(file), value_(value), pointer_(std::move(pointer)) {}

  void require(bool good, const std::string& wanted) const {
    if (!good)
      fail(file_, fmt::format("{} is {} instead of {}: give a provenance.json that mssim wrote",
                              pointer_.empty() ? "the document" : pointer_,
                              printable(value_.dump(-1, ' ', true, json::error_handler_t::replace)), wanted));
  }

  const std::filesystem::path& file_;
  const json& value_;
  std::string pointer_;
};

BuildInfo read_build(const Place& build) {
  return {build["version"].text(),  build["commit"].text(), build["dirty"].truth(),
          build["compiler"].text(), build["flags"].text(),  build["build_type"].text()};
}

Cache read_cache(const Place& cache) {
  return {cache["level"].count<int>(), cache["type"].text(), cache["bytes"].count<std::uint64_t>(),
          cache["count"].count<int>(), cache["logical_cpus_sharing"].count<int>()};
}

Machine read_machine(const Place& document) {
  const Place cpu = document["cpu"];
  Machine machine;
  machine.cpu_model = cpu["model"].text();
  if (const auto generation = cpu.known("generation")) machine.cpu_generation = generation->text();
  machine.logical_cpus = cpu["logical_cpus"].count<int>();
  machine.cpu_mhz = cpu["mhz"].number();
  machine.caches = cpu["caches"].list(read_cache);
  if (const Place governor = cpu["governor"]; !governor.is_null()) machine.governor = governor.text();
  machine.load_average = document["load_average"].list([](const Place& average) { return average.number(); });
  machine.memory_bytes = document["memory_bytes"].count<std::uint64_t>();
  machine.operating_system = document["operating_system"].text();
  machine.kernel = document["kernel"].text();
  if (const auto quota = cpu.known("cpu_quota")) machine.cpu_quota = quota->number();
  if (const auto limit = document.known("memory_limit_bytes"))
    machine.memory_limit_bytes = limit->count<std::uint64_t>();
  if (const auto smt = cpu.known("smt")) machine.smt = smt->truth();
  if (const auto nodes = cpu.find("numa_nodes")) machine.numa_nodes = nodes->count<int>();
  if (const auto turbo = cpu.known("turbo")) machine.turbo = turbo->truth();
  return machine;
}

std::vector<std::pair<std::string, std::string>> read_variables(const Place& environment) {
  return environment.members(
      [](const std::string& name, const Place& value) { return std::pair(name, value.text()); });
}

json variables_json(const std::vector<std::pair<std::string, std::string>>& variables) {
  json environment = json::object();
  for (const auto& [name, value] : variables) environment[name] = value;
  return environment;
}

std::vector<FileHash> read_hashes(const Place& hashes) {
  return hashes.members([](const std::string& name, const Place& value) {
    return FileHash{name, value.hash()};
  });
}

BackendProgramRecord read_program(const std::string& name, const Place& program) {
  BackendProgramRecord record{name, program["command"].list([](const Place& word) { return word.text(); }),
                              read_hashes(program["files_fnv1a_64"])};
  if (const auto environment = program.find("environment")) record.environment = read_variables(*environment);
  if (const auto processes = program.find("processes")) {
    record.ranks = (*processes)["ranks"].count<int>();
    record.rank_threads = (*processes)["threads_a_rank"].count<int>();
    record.launcher = (*processes)["launcher"].text();
  }
  return record;
}

json programs_json(const std::vector<BackendProgramRecord>& programs) {
  json all = json::object();
  for (const BackendProgramRecord& program : programs) {
    json files = json::object();
    for (const FileHash& file : program.files) files[file.name] = to_hex(file.fnv1a_64);
    json& record = all[program.name] = {{"command", program.command}, {"files_fnv1a_64", files}};
    if (!program.environment.empty()) record["environment"] = variables_json(program.environment);
    if (program.ranks > 0)
      record["processes"] = {
          {"ranks", program.ranks}, {"threads_a_rank", program.rank_threads}, {"launcher", program.launcher}};
  }
  return all;
}

Provenance read_document(const Place& document) {
  const auto text_of = [](const Place& place) { return place.text(); };
  document.require_format(folder_format_version);
  const Place threads = document["threads"];
  Provenance provenance;
  provenance.build = read_build(document["build"]);
  provenance.machine = read_machine(document);
  provenance.threads = threads["asked_for"].count<int>();
  provenance.allowed_cpus = threads["allowed_cpus"].list([](const Place& cpu) { return cpu.count<int>(); });
  provenance.thread_environment = read_variables(threads["environment"]);
  provenance.opencl_devices = document["opencl_devices"].list(text_of);
  if (const Place tetgen = document["tetgen"]; !tetgen.is_null()) provenance.tetgen = tetgen.text();
  if (const auto program = document.known("program_fnv1a_64")) provenance.program_fnv1a_64 = program->hash();
  for (const SettingMember& member : setting_members)
    if (const auto setting = document.known(member.name)) provenance.*member.value = setting->text();
  for (const FileHash& scene : read_hashes(document["scenes_fnv1a_64"]))
    provenance.scenes.push_back({scene.name, scene.fnv1a_64});
  if (const auto files = document.find("scene_files_fnv1a_64"))
    for (const FileHash& of_scene : read_hashes(*files))
      for (SceneHash& scene : provenance.scenes)
        if (scene.name == of_scene.name) scene.files_fnv1a_64 = of_scene.fnv1a_64;
  provenance.command_line = document["command_line"].list(text_of);
  provenance.started_utc = document["started_utc"].text();
  if (const auto noise = document.find("noise")) provenance.noise = noise->list(text_of);
  if (const auto programs = document.find("backend_programs"))
    provenance.backend_programs = programs->members(read_program);
  if (const auto earlier = document.find("earlier_starts_utc"))
    provenance.earlier_starts_utc = earlier->list(text_of);
  return provenance;
}

json to_json(const Provenance& provenance) {
  const BuildInfo& build = provenance.build;
  const Machine& machine = provenance.machine;
  json scenes = json::object(), scene_files = json::object();
  for (const SceneHash& scene : provenance.scenes) {
    scenes[scene.name] = to_hex(scene.fnv1a_64);
    if (scene.files_fnv1a_64) scene_files[scene.name] = to_hex(*scene.files_fnv1a_64);
  }
  json all{
      {"format_version", folder_format_version},
      {"started_utc", provenance.started_utc},
      {"earlier_starts_utc", provenance.earlier_starts_utc},
      {"command_line", provenance.command_line},
      {"build",
       {{"version", build.version},
        {"commit", build.commit},
        {"dirty", build.dirty},
        {"compiler", build.compiler},
        {"flags", build.flags},
        {"build_type", build.build_type}}},
      {"program_fnv1a_64", provenance.program_fnv1a_64 ? json(to_hex(*provenance.program_fnv1a_64)) : json()},
      {"cpu",
       {{"model", machine.cpu_model},
        {"generation", machine.cpu_generation.empty() ? json() : json(machine.cpu_generation)},
        {"logical_cpus", machine.logical_cpus},
        {"smt", machine.smt ? json(*machine.smt) : json()},
        {"numa_nodes", machine.numa_nodes},
        {"mhz", machine.cpu_mhz},
        {"governor", machine.governor ? json(*machine.governor) : json()},
        {"turbo", machine.turbo ? json(*machine.turbo) : json()},
        {"cpu_quota", machine.cpu_quota ? json(*machine.cpu_quota) : json()},
        {"caches", caches_json(machine.caches)}}},
      {"memory_bytes", machine.memory_bytes},
      {"memory_limit_bytes", machine.memory_limit_bytes ? json(*machine.memory_limit_bytes) : json()},
      {"load_average", machine.load_average},
      {"operating_system", machine.operating_system},
      {"kernel", machine.kernel},
      {"threads",
       {{"asked_for", provenance.threads},
        {"allowed_cpus", provenance.allowed_cpus},
        {"environment", variables_json(provenance.thread_environment)}}},
      {"opencl_devices", provenance.opencl_devices},
      {"tetgen", provenance.tetgen.empty() ? json() : json(provenance.tetgen)},
      {"backend_programs", programs_json(provenance.backend_programs)},
      {"noise", provenance.noise},
      {"scenes_fnv1a_64", scenes},
      {"scene_files_fnv1a_64", scene_files}};
  for (const SettingMember& member : setting_members) {
    const std::string& setting = provenance.*member.value;
    all[member.name] = setting.empty() ? json() : json(setting);
  }
  return all;
}

}  // namespace

std::string provenance_text(const Provenance& provenance) {
  // A folder's name may contain bytes that are not UTF-8; they are replaced.
  return to_json(provenance).dump(2, ' ', false, json::error_handler_t::replace);
}

Provenance read_provenance(const std::filesystem::path& file) {
  try {
    return parse_provenance(file, read_file(file, largest_provenance_bytes));
  } catch (const ReadError& error) {
    throw ProvenanceError(error.sentence(file, "give a folder that mssim bench wrote"));
  }
}

Provenance parse_provenance(const std::filesystem::path& file, std::string_view text) {
  json document;
  try {
    document = json::parse(text, [&](int depth, json::parse_event_t /*event*/, const json& /*parsed*/) {
      if (depth > deepest_level)
        fail(file, fmt::format("is nested deeper than {} levels: give a provenance.json that mssim wrote",
                               deepest_level));
      return true;
    });
  } catch (const json::exception& error) {
    // The library's message has line and column after its own name in brackets.
    const std::string_view message = error.what();
    const std::size_t start = message.find("] ");
    const std::string problem =
        printable(message.substr(start == std::string_view::npos ? 0 : start + 2), 300);
    fail(file, fmt::format("malformed JSON, {}: give a provenance.json that mssim wrote", problem));
  }
  return read_document({file, document});
}

}  // namespace mssim
