#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
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

/// Frames of a trace that a command uses: --frames, --time, or neither.
struct FrameOptions {
  std::vector<std::string> frames;
  std::optional<double> time_s;

  bool given() const { return time_s || !frames.empty(); }
};

/// Declares --frames and --time; returns --time. `options` must outlive the parsing.
Argument declare_frames(Arguments& arguments, FrameOptions& options);

/// The numbers of the chosen frames in a trace with these times; all if neither option is given. Throws
/// UsageError.
std::vector<std::size_t> chosen_frames(const FrameOptions& options, const std::vector<double>& times_s);

/// Parses --frames: frame numbers from 0, ranges and `last`, separated by commas ("0,10-20,last"), or only
/// `all`. Throws UsageError, also for a frame that a trace of `frames` frames does not have.
std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames);

/// The frame nearest to a time, s. Throws UsageError for a time that is after the last frame by more than
/// the interval before it.
std::size_t frame_at(double time_s, const std::vector<double>& times_s);

/// `count` of `frames`, evenly spread from the first to the last (of one, the last); all if there are no
/// more.
std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count);

/// Default size of single pictures.
inline constexpr const char* usual_picture_size = "960x720";

/// Options of pictures, as given on the command line.
struct PictureChoice {
  std::string view = "three-quarter";
  std::string size;  ///< empty: the default
  ColourBy colour = ColourBy::object;
};

/// Declares --view, --size and --colour. `usual_size` describes the default size in --help. If `needed` is
/// given, each option is an error without it. `choice` must outlive the parsing.
void declare_pictures(Arguments& arguments, PictureChoice& choice, const std::string& usual_size,
                      std::optional<Argument> needed = {});

/// The options of pictures that are drawn by `threads` threads. `usual_size` is WIDTHxHEIGHT. Throws
/// UsageError.
PictureOptions picture_options(const PictureChoice& choice, const std::string& usual_size, int threads);

/// "WIDTHxHEIGHT" as two whole numbers from 1 to `most`; none for any other text.
std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text, std::uint32_t most);

/// The scenes in one argument of --scene, or the backends in one of --backend. A comma separates two, unless
/// it is part of the path of an existing file: from left to right, the longest such path is taken. Empty
/// names between commas are ignored.
std::vector<std::string> names_and_files_in(std::string_view argument);

/// The names of the scenes that come with mssim. Throws SceneError.
std::vector<std::string> scene_names();

/// Every backend that a command may use: the rows of `choice`'s tables, those that come with mssim, and those
/// that the user has described. `broken` gets a sentence for each description that cannot be used.
std::vector<const BackendInfo*> every_backend(BackendChoice& choice, std::vector<std::string>& broken);

/// The names of every backend, and of every integrator.
std::vector<std::string> backend_names();
std::vector<std::string> integrator_names();

/// Declares an argument that takes scenes, by name or file. `target` must outlive the parsing.
Argument add_scenes(Arguments& arguments, const std::string& name, std::vector<std::string>& target,
                    const std::string& description);

/// Declares --backend and --integrator, which take several names and have these descriptions,
/// --backend-folder and --backend-limit; returns all. `asked` must outlive the parsing.
std::vector<Argument> declare_backends_and_integrators(Arguments& arguments, AskedCombinations& asked,
                                                       const std::string& about_backends,
                                                       const std::string& about_integrators);

/// Declares --format for a listing. `target` must outlive the parsing.
void declare_listing_format(Arguments& arguments, ListingFormat& target);

/// Throws UsageError for the first option that is given. `command`: one that takes none of them.
void refuse_options(std::string_view command, std::initializer_list<std::pair<std::string_view, bool>> given);

/// Throws UsageError if there is such a file, unless it is to be replaced. `option` names it, or its folder.
void require_free(const std::filesystem::path& file, std::string_view option, bool overwrite);

/// Accepts the value of --time-budget, s: at most three years, which the nanoseconds of a clock can count.
ValueRule time_budget();

/// Declares --threads, --ranks, --launcher, --device, --memory, --roots and --instruction-set. If `threads`
/// is given, --threads takes several numbers into it; if `sets` is given, --instruction-set takes several
/// names into it. All must outlive the parsing. Returns the options of backends: all but --threads, by which
/// other work is divided, too.
std::vector<Argument> declare_execution(Arguments& arguments, ExecutionOptions& options,
                                        std::vector<int>* threads = nullptr,
                                        std::vector<std::string>* sets = nullptr);

/// Declares --backend-folder. `options` must outlive the parsing.
Argument declare_backend_folders(Arguments& arguments, OwnBackendOptions& options);

/// Declares --backend, --integrator, --duration, --fps, --dt and the options of declare_execution. `options`
/// must outlive the parsing. If `needed` is given, options that only a simulation uses are errors without it.
void declare_stepping(Arguments& arguments, RunOptions& options, const std::string& about_fps,
                      std::optional<Argument> needed = {});

}  // namespace mssim
