#include "output/folders/provenance_file.h"

#include <concepts>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
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

/// A text that the file has as null where it is empty: unknown, or not given.
struct OrNull {
  std::string& text;
};

/// A hash, which the file has as a text, and one that may be unknown: null.
struct Hash {
  std::uint64_t& number;
};
struct HashOrNull {
  std::optional<std::uint64_t>& number;
};

using Variable = std::pair<std::string, std::string>;

/// Elements of lists that the file has as objects: the keys and values there.
std::string& key_of(Variable& variable) { return variable.first; }
std::string& value_of(Variable& variable) { return variable.second; }
std::string& key_of(FileHash& file) { return file.name; }
Hash value_of(FileHash& file) { return {file.fnv1a_64}; }
std::string& key_of(BackendProgramRecord& program) { return program.name; }
BackendProgramRecord& value_of(BackendProgramRecord& program) { return program; }

template <class Element>
concept Keyed = requires(Element& element) {
  key_of(element);
};

/// A value of the document and its place: the root is the file, a member is reached by its key. The document
/// is either written, and its values are null until then, or it is read, into values that are empty.
class Place {
 public:
  /// `file`: the one that is read; null if the document is written.
  Place(json& value, const std::filesystem::path* file, std::string pointer = {})
      : value_(value), file_(file), pointer_(std::move(pointer)) {}

  Place operator[](const char* key) const {
    if (!has(key))
      fail(*file_, fmt::format("{}/{} is missing: give a provenance.json that mssim wrote", pointer_, key));
    return {value_[key], file_, fmt::format("{}/{}", pointer_, key)};
  }
  /// Whether the document that is read has this member; for one that is written, `to_write`.
  bool has(const char* key, bool to_write = true) const {
    if (writes()) return to_write;
    require(value_.is_object(), "an object");
    return value_.contains(key);
  }

  /// Writes or reads a member.
  template <class Value>
  void member(const char* key, Value&& value) const {
    (*this)[key].exchange(value);
  }
  /// The same for a member that files of older versions do not have.
  template <class Value>
  void later_member(const char* key, Value&& value) const {
    if (has(key)) member(key, value);
  }

  /// Writes the version of the format. Throws LaterFormatError if the document has a later one.
  void format_version() const {
    int version = folder_format_version;
    later_member("format_version", version);
    if (version > folder_format_version)
      throw LaterFormatError(
          "{}: /format_version is {}, and this mssim reads versions up to {}: use a newer mssim",
          file_->string(), version, folder_format_version);
  }

 private:
  bool writes() const { return file_ == nullptr; }

  void require(bool good, const std::string& wanted) const {
    if (!good)
      fail(*file_,
           fmt::format("{} is {} instead of {}: give a provenance.json that mssim wrote",
                       pointer_.empty() ? "the document" : pointer_,
                       printable(value_.dump(-1, ' ', true, json::error_handler_t::replace)), wanted));
  }

  /// `good`: whether the document's value is `wanted`.
  template <class Value>
  void exchange(Value& value, bool good, const std::string& wanted) const {
    if (writes()) {
      value_ = value;
    } else {
      require(good, wanted);
      value = value_.get<Value>();
    }
  }
  void exchange(std::string& text) const { exchange(text, value_.is_string(), "a text"); }
  void exchange(bool& truth) const { exchange(truth, value_.is_boolean(), "true or false"); }
  void exchange(double& number) const { exchange(number, value_.is_number(), "a number"); }
  template <std::integral Number>
  void exchange(Number& count) const {
    // The library takes a whole number without a sign as unsigned.
    exchange(count, value_.is_number_unsigned() && std::in_range<Number>(value_.get<std::uint64_t>()),
             fmt::format("a whole number from 0 to {}", std::numeric_limits<Number>::max()));
  }
  void exchange(Hash hash) const {
    if (writes()) {
      value_ = to_hex(hash.number);
      return;
    }
    const auto number = from_hex(value_.is_string() ? value_.get<std::string>() : std::string());
    require(number.has_value(), "16 hexadecimal digits");
    hash.number = *number;
  }
  /// Whether there is a value, to write if `to_write`, or to read; else it is null.
  bool has_value(bool to_write) const { return writes() ? to_write : !value_.is_null(); }
  void exchange(OrNull value) const {
    if (has_value(!value.text.empty())) exchange(value.text);
  }
  void exchange(HashOrNull hash) const {
    if (has_value(hash.number.has_value()))
      exchange(Hash{hash.number ? *hash.number : hash.number.emplace()});
  }
  template <class Value>
  void exchange(std::optional<Value>& value) const {
    if (has_value(value.has_value())) exchange(value ? *value : value.emplace());
  }
  template <class Element>
  void exchange(std::vector<Element>& list) const {
    if (writes()) {
      value_ = json::array_t(list.size());
    } else {
      require(value_.is_array(), "a list");
      list.resize(value_.size());
    }
    for (std::size_t i = 0; i < list.size(); ++i)
      Place(value_[i], file_, fmt::format("{}/{}", pointer_, i)).exchange(list[i]);
  }
  template <Keyed Element>
  void exchange(std::vector<Element>& members) const {
    if (writes()) {
      value_ = json::object();
      for (Element& member : members) Place(value_[key_of(member)], file_).exchange(value_of(member));
      return;
    }
    require(value_.is_object(), "an object");
    for (auto& [key, value] : value_.items()) {
      Element& member = members.emplace_back();
      key_of(member) = key;
      Place(value, file_, pointer_ + '/' + printable(key)).exchange(value_of(member));
    }
  }
  template <class Object>
  void exchange(Object& object) const {
    describe(*this, object);
  }

  json& value_;
  const std::filesystem::path* file_;
  std::string pointer_;
};

/// describe() names the members of an object once, to write and to read them.

void describe(const Place& file, BuildInfo& build) {
  file.member("version", build.version);
  file.member("commit", build.commit);
  file.member("dirty", build.dirty);
  file.member("compiler", build.compiler);
  file.member("flags", build.flags);
  file.member("build_type", build.build_type);
}

void describe(const Place& file, Cache& cache) {
  file.member("level", cache.level);
  file.member("type", cache.type);
  file.member("bytes", cache.bytes);
  file.member("count", cache.count);
  file.member("logical_cpus_sharing", cache.sharing);
}

void describe(const Place& file, Machine& machine) {
  const Place cpu = file["cpu"];
  cpu.member("model", machine.cpu_model);
  cpu.later_member("generation", OrNull{machine.cpu_generation});
  cpu.member("logical_cpus", machine.logical_cpus);
  cpu.member("mhz", machine.cpu_mhz);
  cpu.member("caches", machine.caches);
  cpu.member("governor", machine.governor);
  file.member("load_average", machine.load_average);
  file.member("memory_bytes", machine.memory_bytes);
  file.member("operating_system", machine.operating_system);
  file.member("kernel", machine.kernel);
  cpu.later_member("cpu_quota", machine.cpu_quota);
  file.later_member("memory_limit_bytes", machine.memory_limit_bytes);
  cpu.later_member("smt", machine.smt);
  cpu.later_member("numa_nodes", machine.numa_nodes);
  cpu.later_member("turbo", machine.turbo);
}

void describe(const Place& file, BackendProgramRecord& program) {
  file.member("command", program.command);
  file.member("files_fnv1a_64", program.files);
  if (file.has("environment", !program.environment.empty())) file.member("environment", program.environment);
  if (file.has("processes", program.ranks > 0)) {
    const Place processes = file["processes"];
    processes.member("ranks", program.ranks);
    processes.member("threads_a_rank", program.rank_threads);
    processes.member("launcher", program.launcher);
  }
}

/// The file has the hashes of the scenes' texts and those of the files that they name apart.
void describe(const Place& file, std::vector<SceneHash>& scenes) {
  std::vector<FileHash> texts, files;
  for (const SceneHash& scene : scenes) {
    texts.push_back({scene.name, scene.fnv1a_64});
    if (scene.files_fnv1a_64) files.push_back({scene.name, *scene.files_fnv1a_64});
  }
  file.member("scenes_fnv1a_64", texts);
  file.later_member("scene_files_fnv1a_64", files);
  scenes.clear();
  for (const FileHash& text : texts) scenes.push_back({text.name, text.fnv1a_64});
  for (const FileHash& of_scene : files)
    if (SceneHash* scene = found_in(scenes, of_scene.name, &SceneHash::name))
      scene->files_fnv1a_64 = of_scene.fnv1a_64;
}

void describe(const Place& file, Provenance& provenance) {
  file.format_version();
  const Place threads = file["threads"];
  file.member("build", provenance.build);
  describe(file, provenance.machine);
  threads.member("asked_for", provenance.threads);
  threads.member("allowed_cpus", provenance.allowed_cpus);
  threads.member("environment", provenance.thread_environment);
  file.member("opencl_devices", provenance.opencl_devices);
  file.member("tetgen", OrNull{provenance.tetgen});
  file.later_member("program_fnv1a_64", HashOrNull{provenance.program_fnv1a_64});
  for (const RecordedSetting& setting : recorded_settings)
    file.later_member(setting.member, OrNull{provenance.*setting.value});
  describe(file, provenance.scenes);
  file.member("command_line", provenance.command_line);
  file.member("started_utc", provenance.started_utc);
  file.later_member("noise", provenance.noise);
  file.later_member("backend_programs", provenance.backend_programs);
  file.later_member("earlier_starts_utc", provenance.earlier_starts_utc);
}

}  // namespace

std::string provenance_text(const Provenance& provenance) {
  Provenance described = provenance;  // describe() takes no const one: it also reads
  json document;
  describe(Place(document, nullptr), described);
  // A folder's name may contain bytes that are not UTF-8; they are replaced.
  return document.dump(2, ' ', false, json::error_handler_t::replace);
}

Provenance read_provenance(const std::filesystem::path& file) {
  return parse_provenance(file, read_file_or<ProvenanceError>(file, "give a folder that mssim bench wrote",
                                                              largest_provenance_bytes));
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
  Provenance provenance;
  describe(Place(document, &file), provenance);
  return provenance;
}

}  // namespace mssim
