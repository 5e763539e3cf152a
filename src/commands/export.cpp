#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <vector>

#include "application/console.h"
#include "application/outputs.h"
#include "commands/command.h"
#include "commands/options.h"
#include "output/exports/exports.h"
#include "output/traces/h5md_trace.h"
#include "output/traces/trace_reader.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

enum class ExportFormat : std::uint8_t { obj, ply, vtkhdf };

struct ExportOptions {
  std::string trace, out;
  ExportFormat format = ExportFormat::obj;
  FrameOptions frames;
};

/// File extensions of the format; the first is the default.
std::vector<std::string_view> extensions_of(ExportFormat format) {
  if (format == ExportFormat::vtkhdf) return {".vtkhdf", ".hdf", ".h5", ".hdf5"};
  return {format == ExportFormat::obj ? ".obj" : ".ply"};
}

std::string name_of(ExportFormat format) {
  return format == ExportFormat::obj ? "OBJ" : format == ExportFormat::ply ? "PLY" : "VTKHDF";
}

/// fall.obj -> fall-000012.obj, with the frame's number in the trace.
fs::path numbered(const fs::path& file, std::size_t frame) {
  constexpr std::size_t digits = 6;  // names sort like frames
  return file.parent_path() /
         fmt::format("{}-{:0{}}{}", file.stem().string(), frame, digits, file.extension().string());
}

/// The requested frames, each once and in order of time; by default the last one.
std::vector<std::size_t> exported_frames(const FrameOptions& options, const std::vector<double>& times_s) {
  if (!options.given()) return {times_s.size() - 1};
  std::vector<std::size_t> frames = chosen_frames(options, times_s);
  std::ranges::sort(frames);
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

/// Throws UsageError if the file exists and no mssim export wrote it. Nobody has named it: it may be the
/// surface that the scene of the trace reads.
void require_own(const fs::path& file) {
  constexpr std::string_view mark = "mssim, time ";  // in a comment of obj_of and ply_of
  std::string beginning(64, '\0');
  std::ifstream in(file, std::ios::binary);
  if (!in) return;
  in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  if (beginning.find(mark) == std::string::npos)
    throw UsageError("{} already exists, and mssim did not write it: name another file with --out",
                     printable(file.string(), 1000));
}

/// The files for these frames: one per frame if the format has no times.
std::vector<fs::path> files_for(const ExportOptions& options, const std::vector<std::size_t>& frames) {
  const fs::path out =
      options.out.empty() ? "." / fs::path(options.trace).stem().concat(extensions_of(options.format).front())
                          : fs::path(options.out);
  require_file_name(out);  // before it gets the number of a frame
  require_extension({"--out", out}, name_of(options.format), extensions_of(options.format));
  if (options.format == ExportFormat::vtkhdf || frames.size() == 1) return {target_of(out)};
  return mapped<fs::path>(frames, [&](std::size_t frame) { return target_of(numbered(out, frame)); });
}

void tell_of(std::span<const fs::path> written) {
  if (written.size() > 1)
    tell("wrote {} to {}, {} files", printable(written.front().string()),
         printable(written.back().filename().string()), written.size());
  else if (!written.empty())
    tell("wrote {}", printable(written.front().string()));
}

int run(const ExportOptions& options) {
  const TraceReader trace(options.trace);
  const std::vector<std::size_t> frames = exported_frames(options.frames, trace.content().time_s);
  const std::vector<fs::path> files = files_for(options, frames);
  for (const fs::path& file : files)
    require_distinct({{"--out", file}},
                     {{"the trace", options.trace}, {"the XDMF beside the trace", xdmf_of(options.trace)}});
  if (options.out.empty() && options.format != ExportFormat::vtkhdf)
    std::ranges::for_each(files, require_own);
  const bool solid = options.format == ExportFormat::vtkhdf;
  const ExportMesh mesh = solid ? solid_mesh(trace.content()) : surface_mesh(trace.content());
  if (mesh.triangles.empty() && mesh.tetrahedra.empty())
    throw UsageError(printable(options.trace) + " has no surface to export");
  StopRequest stop;
  if (solid) {
    VtkhdfExport file(files.front(), mesh);
    for (const std::size_t frame : frames) {
      stop.throw_if_requested();
      file.add(frame_of(trace, mesh, frame));
    }
    file.close();
  } else {
    const auto text_of = options.format == ExportFormat::obj ? obj_of : ply_of;
    std::size_t written = 0;
    try {
      for (; written < files.size(); ++written) {
        stop.throw_if_requested();
        write_file_atomically(files[written], text_of(mesh, frame_of(trace, mesh, frames[written])));
      }
    } catch (...) {  // the files before stay
      tell_of(std::span(files).first(written));
      throw;
    }
  }
  tell_of(files);
  return exit_ok;
}

}  // namespace

std::function<int()> declare_export(Arguments& arguments) {
  const auto options = std::make_shared<ExportOptions>();
  arguments.add("TRACE FILE", options->trace, "Trace to export, NAME.h5 (mssim run --trace)").required();
  arguments
      .add_choice("--format", options->format,
                  {{"obj", ExportFormat::obj}, {"ply", ExportFormat::ply}, {"vtkhdf", ExportFormat::vtkhdf}},
                  "Format: obj or ply (triangles, one file per frame) or vtkhdf (all frames in one file, "
                  "bodies as tetrahedra)")
      .required();
  arguments.add(
      "--out FILE", options->out,
      "File to write (default: the trace's name with .obj, .ply or .vtkhdf); if there are several, the "
      "frame's number is appended to the name");
  declare_frames(arguments, options->frames);
  return [options] { return run(*options); };
}

}  // namespace mssim
