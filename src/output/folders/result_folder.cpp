#include "output/folders/result_folder.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "garment/output/garment_tables.h"
#include "output/folders/provenance_file.h"
#include "output/tables/table.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// A file that is made from rows.
struct RowFile {
  const char* name;
  /// Empty if none of the rows belongs in the file.
  std::string (*text)(std::span<const ResultRow> rows, const Provenance& provenance);
};

/// The TABLE of files made from the rows of a run, except for tables of results.
constexpr auto row_files = std::to_array<RowFile>({
    {samples_name, [](std::span<const ResultRow> rows, const Provenance&) { return samples_csv(rows); }},
    {garment_name, [](std::span<const ResultRow> rows, const Provenance&) { return garment_csv(rows); }},
    {benchmark_name, benchmark_json},
    // Written last, so that its rows have their samples.
    {timings_name, [](std::span<const ResultRow> rows, const Provenance&) { return timings_csv(rows); }},
});

std::string csv_of(std::string_view table) { return std::string(table) + ".csv"; }
std::string markdown_of(std::string_view table) { return std::string(table) + ".md"; }

std::vector<FolderFile> files_of(const ResultTable& table) {
  std::vector<FolderFile> files{{csv_of(table.name), table_csv(table.data)}};
  if (!table.page.empty()) files.push_back({markdown_of(table.name), markdown(table.page)});
  return files;
}

FolderFile github_file(std::span<const ResultRow> rows) {
  return {github_name, to_text(github_table(rows), ListingFormat::json)};
}

std::string output_of(const std::string& stem) {
  return (fs::path(programs_name) / (stem + ".txt")).string();
}

/// The files of a row's trace, also those that an ended run has not completed.
std::vector<std::string> traces_of(const std::string& stem) {
  std::vector<std::string> names;
  for (const char* extension : {".h5", ".xdmf"}) {
    const fs::path file = fs::path(traces_name) / (stem + extension);
    names.insert(names.end(), {file.string(), temporary_of(file).string()});
  }
  return names;
}

/// The files in the folder itself, except the provenance.
std::vector<std::string> names_of_results() {
  auto names = mapped<std::string>(row_files, &RowFile::name);
  names.emplace_back(github_name);
  for (const std::string_view table : table_names) {
    names.push_back(csv_of(table));
    names.push_back(markdown_of(table));
  }
  return names;
}

/// That of an earlier run; none if there is none, or a file of this name is somebody else's.
std::optional<Provenance> provenance_in(const fs::path& folder) {
  try {
    return read_provenance(folder / provenance_name);
  } catch (const ErrorWith<exit_bad_input>&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<std::string> file_stems(std::span<const ResultRow> rows) {
  constexpr std::size_t longest = 240;  // of 255, with room for ".xdmf.part"
  std::vector<std::string> stems;
  std::set<std::string> taken;
  for (const ResultRow& row : rows) {
    std::string stem = row.scene + '-' + row.backend + '-' + row.integrator;
    // Characters that no trace may have in its name (trace_name_problem), as in openmp:1.
    for (const char misread : {':', '|', '\\'}) std::ranges::replace(stem, misread, '_');
    if (stem.size() > longest || stem.find('/') != std::string::npos || taken.contains(stem)) {
      const std::string hash = to_hex(fnv1a_64(row.scene + '/' + row.backend + '/' + row.integrator));
      std::ranges::replace(stem, '/', '_');
      stem = fmt::format("{}-{}", beginning_of(stem, longest - 1 - hash.size()), hash);
    }
    taken.insert(stem);
    stems.push_back(std::move(stem));
  }
  return stems;
}

ResultFolder::ResultFolder(fs::path folder, Provenance provenance, TableMaker tables)
    : folder_(std::move(folder)),
      lock_(lock_folder(make_folder(folder_))),
      provenance_(std::move(provenance)),
      tables_(std::move(tables)) {}

bool ResultFolder::has_rows() const { return fs::exists(folder_ / timings_name); }

bool ResultFolder::has_results() const {
  const auto is_there = [&](const std::string& name) { return fs::exists(folder_ / name); };
  return std::ranges::any_of(names_of_results(), is_there) ||
         (is_there(provenance_name) && !provenance_in(folder_));
}

std::vector<std::string> ResultFolder::files_of_rows() const {
  std::vector<std::string> names;
  const std::optional<Provenance> earlier = provenance_in(folder_);
  if (!earlier) return names;
  const bool has_programs = !fs::is_symlink(folder_ / programs_name);
  // A run that was continued may have begun with it.
  const bool has_traces =
      !fs::is_symlink(folder_ / traces_name) &&
      (!earlier->earlier_starts_utc.empty() ||
       std::ranges::find(earlier->command_line, trace_option) != earlier->command_line.end());
  try {
    const std::vector<ResultRow> rows = read_timings(CsvTable(folder_ / timings_name));
    const std::vector<std::string> stems = file_stems(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (has_programs && is_of_program(*earlier, rows[i].backend)) names.push_back(output_of(stems[i]));
      if (has_traces) std::ranges::move(traces_of(stems[i]), std::back_inserter(names));
    }
  } catch (const CsvError&) {
    // Rows that cannot be read do not name their files.
  }
  return names;
}

void ResultFolder::require_free(std::span<const ResultRow> rows, bool with_traces) const {
  if (with_traces && fs::is_symlink(folder_ / traces_name))
    throw UsageError("{} is a link, and traces are not written through it; remove it or choose another --out",
                     (folder_ / traces_name).string());
  const std::vector<std::string> own = files_of_rows();
  for (const std::string& stem : file_stems(rows)) {
    std::vector<std::string> names = with_traces ? traces_of(stem) : std::vector<std::string>();
    names.push_back(output_of(stem));
    for (const std::string& name : names)
      if (fs::exists(folder_ / name) && std::ranges::find(own, name) == own.end())
        throw UsageError("{} is not of an earlier run here: move it, or choose another --out",
                         (folder_ / name).string());
  }
}

void ResultFolder::clear() const {
  std::vector<std::string> names = files_of_rows();
  std::ranges::move(names_of_results(), std::back_inserter(names));
  for (const std::string& name : names)
    if (::unlink((folder_ / name).c_str()) != 0 && errno != ENOENT && errno != ENOTDIR)
      throw WriteError(write_failure(folder_ / name, "removing it", errno));
  // Other files in these folders belong to the user.
  for (const char* name : {programs_name, traces_name}) ::rmdir((folder_ / name).c_str());
}

void ResultFolder::go_on_with(const Provenance& earlier) {
  provenance_.earlier_starts_utc = earlier.earlier_starts_utc;
  provenance_.earlier_starts_utc.push_back(earlier.started_utc);
  goes_on_ = true;
}

void ResultFolder::begin() const {
  AtomicFile file(folder_ / provenance_name);
  file.append(provenance_text(provenance_) + '\n');
  if (!replaces_ && !goes_on_) file.move_into_place();
}

void ResultFolder::write(std::span<const ResultRow> rows) {
  std::vector<FolderFile> files;
  for (const ResultTable& table : tables_(rows, provenance_))
    std::ranges::move(files_of(table), std::back_inserter(files));
  if (!replaces_ && fs::exists(folder_ / github_name)) files.push_back(github_file(rows));
  for (const RowFile& file : row_files)
    if (std::string text = file.text(rows, provenance_); !text.empty())
      files.push_back({file.name, std::move(text)});
  const std::vector<std::string> stems = file_stems(rows);
  std::vector<FolderFile> programs;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (!rows[i].program_output.empty()) programs.push_back({output_of(stems[i]), rows[i].program_output});
  write_files(std::move(files), programs);
}

void ResultFolder::write_for_github(std::span<const ResultRow> rows) const {
  const FolderFile file = github_file(rows);
  write_file_atomically(folder_ / file.name, file.text);
}

void ResultFolder::write(std::span<const ResultTable> tables) {
  std::vector<FolderFile> files;
  for (const ResultTable& table : tables) std::ranges::move(files_of(table), std::back_inserter(files));
  write_files(std::move(files));
}

void ResultFolder::write_files(std::vector<FolderFile> files, const std::vector<FolderFile>& programs) {
  if (std::exchange(goes_on_, false) || replaces_)
    files.insert(files.begin(), {provenance_name, provenance_text(provenance_) + '\n'});
  std::vector<AtomicFile> written;
  written.reserve(files.size());
  for (const FolderFile& file : files) written.emplace_back(folder_ / file.name).append(file.text);
  if (!programs.empty() && fs::is_symlink(folder_ / programs_name))
    throw WriteError("cannot write into {}: it is a link; remove it or choose another folder",
                     (folder_ / programs_name).string());
  if (std::exchange(replaces_, false)) clear();
  if (!programs.empty()) make_folder(folder_ / programs_name);
  for (const FolderFile& output : programs) write_file_atomically(folder_ / output.name, output.text);
  for (AtomicFile& file : written) file.move_into_place();
}

void keep_rounds_of_timings(std::span<ResultRow> rows) {
  for (ResultRow& row : rows) {
    const auto rounds = static_cast<std::size_t>(std::max(0, row.rounds));
    row.samples_ms.resize(std::min(row.samples_ms.size(), rounds));
    row.sample_steps.resize(row.samples_ms.size());
  }
}

std::vector<ResultRow> read_results(const fs::path& folder) {
  if (!fs::exists(folder / timings_name)) return {};
  std::vector<ResultRow> rows = read_timings(CsvTable(folder / timings_name));
  read_samples(CsvTable(folder / samples_name), rows);
  if (fs::exists(folder / garment_name)) read_dressings(CsvTable(folder / garment_name), rows);
  keep_rounds_of_timings(rows);
  return rows;
}

}  // namespace mssim
