#include "output/folders/history_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <tuple>

#include "platform/files.h"
#include "scene/fields/fields.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::size_t most_rows = 10000;
constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
/// A larger file is none that mssim wrote.
constexpr std::size_t largest_history_bytes = std::size_t{256} << 20;
constexpr std::array<std::string_view, 2> truth_words{"no", "yes"};

void visit_row(FieldVisitor& fields, HistoryRow& row) {
  const Range time = from(shortest_ms, longest_ms);
  fields.text({"scene", "The scene's name."}, Presence::required, row.scene);
  fields.integer({"nodes", "Its nodes."}, row.nodes, 0, most);
  fields.text({"backend", "The backend's name."}, Presence::required, row.backend);
  fields.text({"device", "What it ran on."}, Presence::required, row.device);
  fields.text({"integrator", "The integrator's name."}, Presence::required, row.integrator);
  fields.optional_number({"ms_per_step", "Median of the samples, ms."}, row.ms_per_step, time);
  fields.optional_number({"ms_per_step_low", "Lower end of its interval, ms."}, row.ms_per_step_low, time);
  fields.optional_number({"ms_per_step_high", "Upper end of its interval, ms."}, row.ms_per_step_high, time);
  fields.integer({"samples", "Number of samples."}, row.samples, 0, most);
  visit_choice(fields, {"verified", "Whether it agrees with the reference."}, Presence::required, truth_words,
               row.verified);
}

/// The keys of a line, in one place for reading; history_line() writes the same.
void visit_entry(FieldVisitor& fields, HistoryEntry& entry, const std::string& where) {
  std::uint32_t version = history_version;
  fields.integer({"schema_version", "Version of the line."}, version, 1, most);
  if (version != history_version)
    throw InputError(
        "{}: /schema_version is {}, and this mssim reads version {}: use the mssim that wrote it, or begin "
        "another file",
        where, version, history_version);
  fields.text({"commit", "The commit that was measured."}, Presence::required, entry.commit);
  fields.text({"started_utc", "When the run started."}, Presence::required, entry.started_utc);
  fields.text({"processor", "The processor's name."}, Presence::required, entry.processor);
  fields.integer({"logical_cpus", "Its logical CPUs."}, entry.logical_cpus, 0, most);
  fields.integer({"threads", "Threads used."}, entry.threads, 0, most);
  fields.text({"program", "mssim's version and how it was built."}, Presence::required, entry.program);
  fields.list({"rows", "What was measured."}, Presence::required, most_rows, "A combination.",
              [&](FieldVisitor& row) { visit_row(row, entry.rows.emplace_back()); });
}

/// A text that FieldVisitor::text() accepts: cut after it has been escaped, which makes it longer. One that
/// has been read stays as it is.
std::string one_line(const std::string& text) {
  const std::string line = printable(text, text.size());
  return line.size() <= longest_text ? line : printable(line, longest_text - 3);  // and "..."
}

/// Throws InputError if two rows are one series, also as history_line() writes them.
void require_rows_once(const HistoryEntry& entry, const std::string& where) {
  std::set<std::tuple<std::string, std::uint32_t, std::string, std::string, std::string>> known;
  for (const HistoryRow& row : entry.rows)
    if (!known
             .emplace(one_line(row.scene), row.nodes, one_line(row.backend), one_line(row.device),
                      one_line(row.integrator))
             .second)
      throw InputError("{}: /rows/{} has {} on {} a second time; remove one of the two rows", where,
                       &row - entry.rows.data(), combination_name(row), printable(row.device));
}

std::vector<HistoryEntry> entries_in(const std::filesystem::path& file) {
  return parse_history(file, read_file_or<UsageError>(file, "give a file that mssim history add wrote",
                                                      largest_history_bytes));
}

}  // namespace

std::string history_line(const HistoryEntry& entry) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const HistoryRow& row : entry.rows) {
    nlohmann::ordered_json& line = rows.emplace_back();
    line["scene"] = one_line(row.scene);
    line["nodes"] = row.nodes;
    line["backend"] = one_line(row.backend);
    line["device"] = one_line(row.device);
    line["integrator"] = one_line(row.integrator);
    if (row.ms_per_step) line["ms_per_step"] = *row.ms_per_step;
    if (row.ms_per_step_low) line["ms_per_step_low"] = *row.ms_per_step_low;
    if (row.ms_per_step_high) line["ms_per_step_high"] = *row.ms_per_step_high;
    line["samples"] = row.samples;
    line["verified"] = truth_words.at(row.verified ? 1 : 0);
  }
  return nlohmann::ordered_json{
      {"schema_version", history_version},          {"commit", one_line(entry.commit)},
      {"started_utc", one_line(entry.started_utc)}, {"processor", one_line(entry.processor)},
      {"logical_cpus", entry.logical_cpus},         {"threads", entry.threads},
      {"program", one_line(entry.program)},         {"rows", rows}}
      .dump();
}

std::string history_schema() {
  HistoryEntry entry;
  return json_schema("A line of a history", "What mssim history add appends to a file, on a line of its own.",
                     [&](FieldVisitor& fields) { visit_entry(fields, entry, ""); });
}

std::vector<HistoryEntry> parse_history(const std::filesystem::path& file, std::string_view text) {
  std::vector<HistoryEntry> history;
  text = without_byte_order_mark(text);
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = take_to(text, "\n");
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    const std::string where = fmt::format("{}, line {}", file.string(), number);
    HistoryEntry& entry = history.emplace_back();
    // Messages about the syntax count lines, too: those before this one are kept as empty ones.
    read_fields(where, std::string(number - 1, '\n') + std::string(line),
                [&](FieldVisitor& fields) { visit_entry(fields, entry, where); });
    require_rows_once(entry, where);
    if (std::any_of(history.begin(), history.end() - 1, [&](const HistoryEntry& earlier) {
          return earlier.commit == entry.commit && machine_of(earlier) == machine_of(entry);
        }))
      throw InputError("{}: an earlier line has commit {} on {}, too; remove one of the two lines", where,
                       printable(entry.commit), printable(machine_of(entry)));
  }
  return history;
}

std::vector<HistoryEntry> read_history(const std::filesystem::path& file) {
  std::vector<HistoryEntry> history = entries_in(file);
  if (history.empty())
    throw UsageError("{} has no entries: add a result folder with mssim history add", file.string());
  return history;
}

void change_history(const std::filesystem::path& file,
                    const std::function<void(std::vector<HistoryEntry>& history)>& change) {
  AtomicFile written(target_of(file));
  std::vector<HistoryEntry> history;
  std::error_code error;
  if (std::filesystem::exists(file, error)) history = entries_in(file);
  change(history);
  for (const HistoryEntry& entry : history) written.append(history_line(entry) + '\n');
  written.move_into_place();
}

}  // namespace mssim
