#include "web/web.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "application/bench/suites.h"
#include "application/console.h"
#include "application/outputs.h"
#include "commands/command.h"
#include "output/folders/provenance_file.h"
#include "output/folders/result_folder.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

struct WebOptions {
  std::string out, results = "web-results";
  bool serve = false, once = false;
  int port = 0;
};

/// The name of a run's folder: its start. Throws UsageError if that is no time.
std::string folder_name(std::string name) {
  constexpr std::string_view form = "0000-00-00T00:00:00Z";
  const auto fits = [](char c, char of_form) { return of_form == '0' ? c >= '0' && c <= '9' : c == of_form; };
  if (!std::ranges::equal(name, form, fits))
    throw UsageError(
        "the page's results: /provenance/started_utc is \"{}\": give a time such as "
        "2026-01-31T12:00:00Z",
        printable(name));
  std::ranges::replace(name, ':', '-');
  return name;
}

/// Whether the folder has the results of another device.
bool is_of_another_device(const fs::path& folder, const Provenance& provenance) {
  std::error_code error;  // writing there says it
  if (!fs::exists(folder / provenance_name, error)) return false;
  const Provenance there = read_provenance(folder / provenance_name);
  return there.machine.cpu_model != provenance.machine.cpu_model ||
         there.machine.kernel != provenance.machine.kernel;
}

/// Writes what a page has sent into a folder of its own, named by its start, and says which. Results that a
/// device sends again replace its earlier ones.
std::string keep(const fs::path& results, const std::string& text) {
  const MeasuredRun run = parse_web_results("the page's results", text);
  const std::string name = folder_name(run.provenance.started_utc);
  fs::path folder = results / name;
  for (int i = 2; is_of_another_device(folder, run.provenance); ++i)
    folder = results / fmt::format("{}-{}", name, i);
  ResultFolder written(folder, run.provenance, comparison_of_suite("tables").tables());
  written.replace_results();
  written.write(run.rows);
  tell("wrote {}", printable(folder.string()));
  return folder.string();
}

int web(const WebOptions& options) {
  if (options.out.empty() && !options.serve)
    throw UsageError("give --out FILE.html to write the page, or --serve to serve it");
  if (!options.out.empty()) {
    const fs::path out = target_of(options.out);
    require_extension({"--out", out}, "HTML", {".html", ".htm"});
    AtomicFile(out).remove();  // finds what cannot be written before bodies are meshed
    const std::string page = web_page();
    write_file_atomically(out, page);
    tell("wrote {}", printable(out.string()));
    return exit_ok;
  }
  AtomicFile(make_folder(options.results) / ".probe").remove();  // before a phone has measured
  serve_page(options.port, options.once,
             [&](const std::string& text) { return keep(options.results, text); });
  return exit_ok;
}

}  // namespace

std::function<int()> declare_web(Arguments& arguments) {
  const auto options = std::make_shared<WebOptions>();
  const Argument out =
      arguments.add("--out FILE", options->out, "Write the page to this file, for any static host");
  Argument serve = arguments.add_flag(
      "--serve", options->serve, "Serve the page on this machine's loopback address, and print the address");
  serve.excludes(out);
  arguments
      .add("--results DIR", options->results,
           "With --serve: folder for the results that pages send, a folder each (default: web-results)")
      .needs(serve);
  arguments
      .add_number("--port N", options->port, "With --serve: port (default: any free one)",
                  whole_number(0, 65535))
      .needs(serve);
  arguments.add_flag("--once", options->once, "With --serve: end after the first result").needs(serve);
  return [options] { return web(*options); };
}

}  // namespace mssim
