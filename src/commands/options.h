#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "application/choices.h"
#include "application/run.h"
#include "commands/arguments/arguments.h"
#include "output/pictures/painter.h"
#include "output/tables/table.h"

namespace mssim {

/// Which frames of a trace a command takes: --frames or --time, or neither.
struct FrameOptions {
  std::vector<std::string> frames;
  std::optional<double> time_s;

  bool given() const { return time_s || !frames.empty(); }
};

/// Declares --frames and --time; returns the latter. `options` must outlive the parsing.
Argument declare_frames(Arguments& arguments, FrameOptions& options);

/// Those frames, by numbers, of a trace whose frames have these times; all where neither option is given.
/// Throws UsageError.
std::vector<std::size_t> chosen_frames(const FrameOptions& options, const std::vector<double>& times_s);

/// What --frames says: frame numbers from 0 on and ranges of them, separated by commas, and `last`: for
/// example "0,10-20,last"; or `all` alone. Throws UsageError, also for a frame that a trace of `frames`
/// frames does not have.
std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames);

/// The frame nearest to a time, s. Throws UsageError for a time that lies more than half a frame beyond them.
std::size_t frame_at(double time_s, const std::vector<double>& times_s);

/// `count` of `frames`, evenly spread from the first to the last; all where there are no more.
std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count);

/// Size of pictures that are written one by one.
inline constexpr const char* usual_picture_size = "960x720";

/// How pictures are to look, in the words of the command line.
struct PictureChoice {
  std::string view = "three-quarter";
  std::string size;  ///< empty: as large as is usual
  ColourBy colour = ColourBy::object;
};

/// Declares --view, --size and --colour. `usual_size` is what --help says of sizes that are not given. Where
/// `needed` is given, each is an error without it. `choice` must outlive the parsing.
void declare_pictures(Arguments& arguments, PictureChoice& choice, const std::string& usual_size,
                      std::optional<Argument> needed = {});

/// The choice as options, drawn by so many threads. `usual_size` is WIDTHxHEIGHT. Throws UsageError.
PictureOptions picture_options(const PictureChoice& choice, const std::string& usual_size, int threads);

/// "WIDTHxHEIGHT" as two whole numbers from 1 to `most`; none where it is something else.
std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text, std::uint32_t most);

/// The scenes of one argument of --scene, or the backends of --backend. A comma separates two, unless it is
/// part of a path under which there is a file: from left to right the longest such path is taken. Empty names
/// between commas are left out.
std::vector<std::string> names_and_files_in(std::string_view argument);

/// Declares an argument that takes scenes: names or files. `target` must outlive the parsing.
Argument add_scenes(Arguments& arguments, const std::string& name, std::vector<std::string>& target,
                    const std::string& description);

/// Declares --format of a listing. `target` must outlive the parsing.
void declare_listing_format(Arguments& arguments, ListingFormat& target);

/// Declares --threads, --ranks, --launcher, --device, --memory and --roots. `options` must outlive the
/// parsing, and so must `threads`, which takes several numbers instead, where it is given.
void declare_execution(Arguments& arguments, ExecutionOptions& options, std::vector<int>* threads = nullptr);

/// Declares --backend-folder. `options` must outlive the parsing.
Argument declare_backend_folders(Arguments& arguments, OwnBackendOptions& options);

/// Declares --backend-limit. `options` must outlive the parsing.
Argument declare_backend_limit(Arguments& arguments, OwnBackendOptions& options);

/// Declares --backend, --integrator, --duration, --fps, --dt and those of declare_execution. `options` must
/// outlive the parsing. Where `needed` is given, those that only a simulation takes are errors without it.
void declare_stepping(Arguments& arguments, RunOptions& options, const std::string& about_fps,
                      std::optional<Argument> needed = {});

}  // namespace mssim
