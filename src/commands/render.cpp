#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "application/choices.h"
#include "application/console.h"
#include "application/outputs.h"
#include "application/run.h"
#include "commands/command.h"
#include "commands/options.h"
#include "garment/spec/garment_spec.h"
#include "output/pictures/painter.h"
#include "output/traces/h5md_trace.h"
#include "output/traces/trace_reader.h"
#include "picture/movie.h"
#include "picture/picture.h"
#include "platform/files.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string trace;
  RunOptions run;  ///< for --scene; its fps also applies to a movie
  std::string out, sheet_size;
  PictureChoice look;
  FrameOptions frames;
  std::optional<std::string> movie;  ///< the file, if named by --movie instead of --out
};

constexpr double movie_fps = 30;
/// Browsers show a frame of 10 ms or less for 100 ms.
constexpr double browser_fps = 90;
constexpr std::uint32_t most_on_a_sheet = 20;  // across and down

using Size = std::pair<std::uint32_t, std::uint32_t>;

/// Columns and rows of the sheet; none without --sheet.
std::optional<Size> sheet_size(const RenderOptions& options) {
  const auto sheet = two_numbers(options.sheet_size, most_on_a_sheet);
  if (!sheet && !options.sheet_size.empty())
    throw UsageError("--sheet: \"{}\" is not a number of pictures; give COLUMNSxROWS, up to {} each",
                     printable(options.sheet_size), most_on_a_sheet);
  return sheet;
}

constexpr const char* size_of_many = "640x480";  // on a sheet and in a movie

PictureOptions pictures_of(const RenderOptions& options) {
  const bool alone = options.sheet_size.empty() && !options.movie;
  return picture_options(options.look, alone ? usual_picture_size : size_of_many,
                         complete(options.run.execution).threads);
}

/// "bodies20587" for a scene's name or file, "fall" for fall.h5.
std::string stem_of(const RenderOptions& options) {
  return fs::path(options.trace.empty() ? options.run.scene : options.trace).stem().string();
}

fs::path output_of(const RenderOptions& options) {
  if (options.movie && !options.movie->empty()) return *options.movie;
  if (!options.out.empty()) return options.out;
  return fs::path(".") / (stem_of(options) + (options.movie                ? ".webp"
                                              : options.sheet_size.empty() ? ".png"
                                                                           : "-sheet.png"));
}

/// The number of moments on a sheet, if there is one: a legend takes the last place.
std::optional<std::size_t> moments_on_sheet(const RenderOptions& options, bool has_legend) {
  const auto sheet = sheet_size(options);
  if (!sheet) return std::nullopt;
  const std::size_t places = std::size_t{sheet->first} * sheet->second;
  return places > 1 && has_legend ? places - 1 : places;
}

/// Frame rate at which a movie runs in simulated time.
double natural_fps(const TraceContent& content, const std::vector<std::size_t>& frames) {
  const double simulated_s = content.time_s[frames.back()] - content.time_s[frames.front()];
  return simulated_s > 0 ? static_cast<double>(frames.size() - 1) / simulated_s : movie_fps;
}

/// Every k-th frame, so that browsers show a movie of them in simulated time.
std::vector<std::size_t> frames_for_browsers(const TraceContent& content,
                                             const std::vector<std::size_t>& frames) {
  const double most = static_cast<double>(frames.size());
  const auto k =
      static_cast<std::size_t>(std::ceil(std::min(natural_fps(content, frames) / browser_fps, most)));
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < frames.size(); i += k) kept.push_back(frames[i]);
  return kept;
}

/// The frames to draw, in order.
std::vector<std::size_t> drawn_frames(const RenderOptions& options, const TraceContent& content,
                                      bool has_legend) {
  std::vector<std::size_t> chosen = chosen_frames(options.frames, content.time_s);
  if (const auto moments = moments_on_sheet(options, has_legend)) return spread_over(chosen, *moments);
  if (options.movie) return options.run.fps ? chosen : frames_for_browsers(content, chosen);
  if (!options.frames.frames.empty() && chosen.size() > 1)
    throw UsageError("--frames names {}, and a picture shows one: name one, or give --sheet or --movie, too",
                     pluralize(chosen.size(), "frame"));
  return {chosen.back()};
}

/// Decimals of seconds, at least two, with which different times of the frames are written differently.
int decimals_of_times(const TraceContent& content, const std::vector<std::size_t>& frames) {
  constexpr double nanosecond = 1e-9;
  std::vector<double> times_s =
      mapped<double>(frames, [&](std::size_t frame) { return content.time_s[frame]; });
  std::ranges::sort(times_s);
  double least_s = 1;
  for (std::size_t i = 1; i < times_s.size(); ++i)
    if (const double distance_s = times_s[i] - times_s[i - 1]; distance_s > nanosecond)
      least_s = std::min(least_s, distance_s);
  // The last decimal is finer than the distance: 0.005 and 0.015 would both be rounded to 0.01.
  return std::max(2, static_cast<int>(std::floor(1 - std::log10(0.999 * least_s))));
}

/// Draws the chosen frames of a trace. Throws Interrupted. Returns the bytes of the file, and a description
/// of its content.
std::string drawn_file(const RenderOptions& options, const PictureOptions& picture, const TraceReader& trace,
                       StopRequest& stop) {
  const TraceContent& content = trace.content();
  if (picture.colour == ColourBy::strain && !has_strain(content))
    throw UsageError("{} has no rest lengths of its springs, and so no strain: leave --colour out",
                     printable(options.trace));
  Painter painter(content, trace.positions(0), picture);
  const std::vector<std::size_t> frames = drawn_frames(options, content, painter.has_legend());
  const auto sheet = sheet_size(options);
  const bool legend_apart = painter.has_legend() && sheet && sheet->first * sheet->second > 1;
  for (const std::size_t frame : frames) {
    stop.throw_if_requested();
    painter.make_room_for(trace.positions(frame));
  }
  ProgressLine progress({1}, ProgressLine::Log::nothing);
  progress.begin_scene(stem_of(options));
  std::optional<Movie> movie;
  if (options.movie)
    movie.emplace(options.run.fps.value_or(std::clamp(natural_fps(content, frames), 0.1, browser_fps)));
  std::vector<CaptionedPicture> pictures;
  const int decimals = decimals_of_times(content, frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    stop.throw_if_requested();
    Picture drawn = painter.picture_of(trace.positions(frames[i]), !legend_apart);
    progress.update_often(fmt::format("picture {} of {}", i + 1, frames.size()),
                          static_cast<double>(i + 1) / static_cast<double>(frames.size()));
    if (movie)
      movie->add(drawn);
    else
      pictures.push_back(
          {std::move(drawn), fmt::format("t = {:.{}f} s", content.time_s[frames[i]], decimals)});
  }
  if (movie) return movie->take_bytes();
  if (legend_apart) pictures.push_back({painter.legend(), ""});
  if (sheet) return png_of(sheet_of(pictures, sheet->first));
  return png_of(pictures.front().picture);
}

double duration_s(const RenderOptions& options) {
  return options.run.duration_s.value_or(default_duration_s);
}

/// It is unknown when a garment will have settled.
bool ends_when_settled(const RenderOptions& options) {
  return std::holds_alternative<GarmentSpec>(find_scene(options.run.scene).content);
}

/// Frames per simulated second that the pictures need if --fps names no others. A large scene has a large
/// trace, so it takes no more.
double usual_fps(const RenderOptions& options) {
  if (options.movie || options.frames.given()) return movie_fps;
  const std::size_t moments = moments_on_sheet(options, options.look.colour == ColourBy::strain).value_or(2);
  if (sheet_size(options) && ends_when_settled(options)) return movie_fps;
  return static_cast<double>(std::max<std::size_t>(moments, 2) - 1) / duration_s(options);
}

/// Throws UsageError if --time is after the last frame that the run of a scene will have. Nearer to the end,
/// frame_at() knows.
void require_time_within(const RenderOptions& options, const RunOptions& run) {
  const double interval_s = 1 / run.fps.value_or(run.usual_fps);
  if (options.frames.time_s && *options.frames.time_s > duration_s(options) + interval_s &&
      !ends_when_settled(options))
    throw UsageError(
        "--time: {} s is after the end of the run, at {} s; give a longer --duration or an earlier "
        "--time",
        decimal(*options.frames.time_s), decimal(duration_s(options)));
}

int render(const RenderOptions& options) {
  const PictureOptions picture = pictures_of(options);
  // Checked before anything is simulated.
  if (sheet_size(options)) require_font();
  if (options.movie && options.run.fps && (*options.run.fps < 0.1 || *options.run.fps > 1000))
    throw UsageError("--fps: a movie has 0.1 to 1000 frames per second, not " + decimal(*options.run.fps));
  if (options.movie && !options.movie->empty() && !options.out.empty())
    throw UsageError("--movie and --out both name the file: \"{}\" and \"{}\"; leave one of them out",
                     printable(*options.movie), printable(options.out));
  if (options.trace.empty() == options.run.scene.empty())
    throw UsageError(options.movie && fs::path(*options.movie).extension() == ".h5"
                         ? fmt::format("--movie took \"{}\" for the file to write; put the trace before it",
                                       printable(*options.movie))
                         : "give either a trace or --scene");
  fs::path trace = options.trace;
  if (is_scene(options.trace) && (trace.extension() == ".json" || !fs::exists(trace)))
    throw UsageError("\"{0}\" is a scene, not a trace: did you mean --scene {0}?", printable(options.trace));
  if (!trace.empty() && options.run.fps && !options.movie)
    throw UsageError("--fps with a trace is that of a movie: give --movie, too, or leave --fps out");
  const fs::path out = target_of(output_of(options));
  require_extension({options.movie && !options.movie->empty() ? "--movie" : "--out", out},
                    options.movie ? "an animated WebP" : "PNG",
                    {options.movie ? std::string_view(".webp") : std::string_view(".png")});
  int code = exit_ok;
  if (trace.empty()) {
    RunOptions run = options.run;
    run.usual_fps = usual_fps(options);
    require_time_within(options, run);
    trace = temporary_folder_of_process() / "scene.h5";
    run.files.trace = trace.string();
    run.files.temporary = true;
    run.files.later = {"--out", out};
    code = run_scene(run);
  } else {
    require_distinct({{"--out", out}}, {{"the trace", trace}, {"the XDMF beside the trace", xdmf_of(trace)}});
  }
  StopRequest stop;  // a temporary trace must not stay
  const TraceReader reader(trace);
  write_file_atomically(out, drawn_file(options, picture, reader, stop));
  tell("wrote {}", printable(out.string()));
  return code;
}

}  // namespace

std::function<int()> declare_render(Arguments& arguments) {
  const auto options = std::make_shared<RenderOptions>();
  const Argument trace =
      arguments.add("TRACE FILE", options->trace, "Trace to draw, NAME.h5 (mssim run --trace)");
  const Argument scene =
      arguments
          .add("--scene NAME|FILE", options->run.scene, "Simulate this scene and draw it: a name or a file")
          .offers(scene_names)
          .excludes(trace);
  arguments.add("--out FILE", options->out,
                "File to write (default: the trace's or the scene's name with .png, -sheet.png or .webp)");
  declare_pictures(arguments, options->look,
                   fmt::format("{}, and {} on a sheet and in a movie", usual_picture_size, size_of_many));
  const Argument time = declare_frames(arguments, options->frames);
  const Argument sheet = arguments
                             .add("--sheet COLUMNSxROWS", options->sheet_size,
                                  "Put this many moments, evenly spread, on one sheet")
                             .excludes(time);
  arguments
      .add_flag_with_text("--movie [FILE]", options->movie,
                          "Write an animated WebP of the frames, to this file or that of --out")
      .excludes(sheet)
      .excludes(time);
  declare_stepping(arguments, options->run,
                   "Frames per simulated second of a scene (default: as many as are drawn; 30 for a movie, "
                   "with --time and with --frames), and per "
                   "second of a movie (default: as simulated; browsers slow down more than 90)",
                   scene);
  return [options] { return render(*options); };
}

}  // namespace mssim
