#include "commands/options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "integrators/all_integrators.h"
#include "picture/picture.h"
#include "platform/machine.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

std::size_t frame_number(const std::string& word, std::size_t frames) {
  if (word == "last") return frames - 1;
  const auto number = number_in<std::int64_t>(word);
  if (!number || *number < 0)
    throw UsageError(
        "--frames: \"{}\" is not a frame; give numbers from 0 on, ranges like 10-20, last, or all",
        printable(word));
  if (static_cast<std::uint64_t>(*number) >= frames)
    throw UsageError("--frames: there is no frame {}; the last one is {}", *number, frames - 1);
  return static_cast<std::size_t>(*number);
}

std::vector<std::size_t> all_of(std::size_t frames) {
  std::vector<std::size_t> list(frames);
  std::iota(list.begin(), list.end(), std::size_t{0});
  return list;
}

/// Length of the first name or file in the text. Files of scenes and of backends are recognised in the same
/// way: a path that exists.
std::size_t length_of_first(std::string_view text) {
  const std::size_t shortest = std::min(text.find(','), text.size());
  for (std::size_t end = text.size(); end != std::string_view::npos && end > shortest;
       end = text.rfind(',', end - 1))
    if (is_scene(text.substr(0, end))) return end;
  return shortest;
}

Argument declare_backend_limit(Arguments& arguments, OwnBackendOptions& options) {
  return arguments.add_number("--backend-limit SECONDS", options.limit_s,
                              "Time limit for each answer of a program that is a backend (default: 120)",
                              number_between(0.001, longest_time_limit_s));
}

}  // namespace

Argument declare_frames(Arguments& arguments, FrameOptions& options) {
  const Argument time = arguments.add_number("--time SECONDS", options.time_s,
                                             "Take the frame nearest to this time (default: the last frame)",
                                             number_between(0, 1e9));
  arguments
      .add_list("--frames LIST", options.frames,
                "Take only these frames: numbers from 0 on, ranges like 10-20, last, all")
      .excludes(time);
  return time;
}

std::vector<std::size_t> chosen_frames(const FrameOptions& options, const std::vector<double>& times_s) {
  if (options.time_s) return {frame_at(*options.time_s, times_s)};
  return options.frames.empty() ? all_of(times_s.size()) : listed_frames(options.frames, times_s.size());
}

std::vector<std::size_t> listed_frames(const std::vector<std::string>& words, std::size_t frames) {
  std::vector<std::size_t> list;
  if (words == std::vector<std::string>{"all"}) return all_of(frames);
  for (const std::string& word : words) {
    const std::size_t dash = word.find('-', 1);
    const std::size_t first = frame_number(word.substr(0, dash), frames);
    const std::size_t last = dash == std::string::npos ? first : frame_number(word.substr(dash + 1), frames);
    if (last < first)
      throw UsageError("--frames: \"{}\" ends before it begins; give the smaller number first",
                       printable(word));
    for (std::size_t frame = first; frame <= last; ++frame) list.push_back(frame);
  }
  return list;
}

std::size_t frame_at(double time_s, const std::vector<double>& times_s) {
  const auto nearest = std::ranges::min_element(
      times_s, {}, [&](double frame_time_s) { return std::abs(frame_time_s - time_s); });
  const double spacing = times_s.size() < 2 ? 0 : times_s.back() - times_s[times_s.size() - 2];
  if (time_s > times_s.back() + spacing)
    throw UsageError("--time: {} s is after the last frame, at {} s; give an earlier one", decimal(time_s),
                     decimal(times_s.back()));
  return static_cast<std::size_t>(nearest - times_s.begin());
}

std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count) {
  if (frames.size() <= count) return frames;
  if (count == 1) return {frames.back()};
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(frames[(i * (frames.size() - 1) + (count - 1) / 2) / (count - 1)]);
  return chosen;
}

void declare_pictures(Arguments& arguments, PictureChoice& choice, const std::string& usual_size,
                      std::optional<Argument> needed) {
  const std::array all{
      arguments.add("--view VIEW", choice.view,
                    "Viewpoint: front, side, back, three-quarter, or AZIMUTH,ELEVATION in degrees "
                    "(default: three-quarter)"),
      arguments.add("--size WIDTHxHEIGHT", choice.size,
                    "Size of a picture in pixels (default: " + usual_size + ')'),
      arguments.add_choice(
          "--colour", choice.colour,
          {{"object", ColourBy::object}, {"panel", ColourBy::panel}, {"strain", ColourBy::strain}},
          "What the colours show: object, panel (of a garment, else as object) or strain (default: object)")};
  for (Argument argument : all)
    if (needed) argument.needs(*needed);
}

PictureOptions picture_options(const PictureChoice& choice, const std::string& usual_size, int threads) {
  const auto view = view_direction(choice.view);
  if (!view)
    throw UsageError("--view: \"" + printable(choice.view) +
                     "\" is not a view; give front, side, back, three-quarter, or AZIMUTH,ELEVATION in "
                     "degrees, up to 360 and 90");
  const auto size = two_numbers(choice.size.empty() ? usual_size : choice.size, most_picture_pixels);
  if (!size)
    throw UsageError("--size: \"{}\" is not a size; give WIDTHxHEIGHT, up to {} pixels each",
                     printable(choice.size), most_picture_pixels);
  if (choice.colour != ColourBy::object) require_font();  // for the legend
  return {*view, size->first, size->second, choice.colour, threads};
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text,
                                                                   std::uint32_t most) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto first = number_in<std::uint32_t>(text.substr(0, x));
  const auto second = number_in<std::uint32_t>(text.substr(x + 1));
  const auto good = [&](const std::optional<std::uint32_t>& n) { return n && *n >= 1 && *n <= most; };
  if (!good(first) || !good(second)) return std::nullopt;
  return std::pair{*first, *second};
}

std::vector<std::string> names_and_files_in(std::string_view argument) {
  std::vector<std::string> names;
  while (!argument.empty()) {
    const std::size_t length = length_of_first(argument);
    if (length > 0) names.emplace_back(argument.substr(0, length));
    argument.remove_prefix(std::min(length + 1, argument.size()));
  }
  return names;
}

std::vector<std::string> scene_names() { return mapped<std::string>(shipped_scenes(), &SceneSpec::name); }

std::vector<const BackendInfo*> every_backend(BackendChoice& choice, std::vector<std::string>& broken) {
  std::vector<const BackendInfo*> all = with_garment_backends(table_backends());
  std::ranges::copy(choice.shipped(&broken), std::back_inserter(all));
  std::ranges::copy(choice.described(&broken), std::back_inserter(all));
  return all;
}

std::vector<std::string> backend_names() {
  BackendChoice choice(with_garment_backends(table_backends()), {});
  std::vector<std::string> broken;  // have no names
  return mapped<std::string>(every_backend(choice, broken), &BackendInfo::name);
}

std::vector<std::string> integrator_names() {
  return mapped<std::string>(all_integrators, &Integrator::name);
}

Argument add_scenes(Arguments& arguments, const std::string& name, std::vector<std::string>& target,
                    const std::string& description) {
  return arguments
      .add_list(name + " NAME|FILE,...", target,
                description + ", separated by commas (but not at a comma in the name of an existing file)",
                names_and_files_in)
      .offers(scene_names);
}

std::vector<Argument> declare_backends_and_integrators(Arguments& arguments, AskedCombinations& asked,
                                                       const std::string& about_backends,
                                                       const std::string& about_integrators) {
  return {arguments.add_list("--backend NAME|FILE,...", asked.backends, about_backends, names_and_files_in)
              .offers(backend_names),
          declare_backend_folders(arguments, asked.own_backends),
          declare_backend_limit(arguments, asked.own_backends),
          arguments.add_list("--integrator NAME,...", asked.integrators, about_integrators)
              .offers(integrator_names)};
}

void declare_listing_format(Arguments& arguments, ListingFormat& target) {
  arguments.add_choice<ListingFormat>(
      "--format", target,
      {{"table", ListingFormat::table}, {"csv", ListingFormat::csv}, {"json", ListingFormat::json}},
      "What to print: table, csv or json (default: table)");
}

void refuse_options(std::string_view command,
                    std::initializer_list<std::pair<std::string_view, bool>> given) {
  for (const auto& [name, is_given] : given)
    if (is_given) throw UsageError("mssim {} takes no {}: leave it out", command, name);
}

void require_free(const std::filesystem::path& file, std::string_view option, bool overwrite) {
  if (std::error_code error; std::filesystem::exists(file, error) && !overwrite)
    throw UsageError("{} already exists: give another {}, or --overwrite to replace it",
                     printable(file.string(), 1000), option);
}

ValueRule time_budget() { return number_between(0.001, 1e8); }

std::vector<Argument> declare_execution(Arguments& arguments, ExecutionOptions& options,
                                        std::vector<int>* threads, std::vector<std::string>* sets) {
  constexpr std::string_view several = "; each of several gets rows of its own";
  const std::string meaning =
      "Threads, and compute units of an OpenCL device that is a CPU (default: one per available CPU)";
  const std::string of_sets =
      "Instruction set of the vector code of openmp, gather-vectors and mpi (default: the best)";
  if (threads == nullptr)
    arguments.add_number("--threads N", options.threads, meaning, whole_number(1, most_threads));
  else
    arguments.add_number("--threads N,...", *threads, meaning + std::string(several),
                         whole_numbers(1, most_threads));
  return {
      arguments.add_number("--ranks N", options.ranks,
                           "Processes of the backend mpi, of --threads threads each; mpi:N sets it for one "
                           "row (default: as many as --threads, of one thread each)",
                           whole_number(1, most_ranks)),
      arguments.add("--launcher COMMAND", options.launcher,
                    "Launcher of the backend mpi, to which mssim appends `-n N PROGRAM` (default: mpirun)",
                    [](const std::string& text) -> std::string {
                      if (text.find_first_not_of(" \t\r\n") != std::string::npos) return "";
                      return fmt::format("\"{}\" names no program", printable(text));
                    }),
      arguments.add("--device N|NAME", options.device,
                    "OpenCL device: its number or a part of its name or platform (see mssim list devices)"),
      arguments.add_choice<DeviceMemory>(
          "--memory", options.memory,
          {{name_of(DeviceMemory::copy), DeviceMemory::copy},
           {name_of(DeviceMemory::shared), DeviceMemory::shared}},
          "How host and OpenCL device exchange data: shared (without copying if the device can) or copy "
          "(default: shared)"),
      arguments.add_choice<Roots>(
          "--roots", options.roots,
          {{name_of(Roots::exact), Roots::exact}, {name_of(Roots::fast), Roots::fast}},
          "How openmp and gather-vectors compute the lengths of springs: fast (with AVX-512, an estimate and "
          "a Newton step) or exact (bitwise identical on every processor with fused multiply-adds) "
          "(default: fast)"),
      (sets == nullptr
           ? arguments.add("--instruction-set NAME", options.instruction_set, of_sets)
           : arguments.add_list("--instruction-set NAME,...", *sets, of_sets + std::string(several)))
          .offers([] { return mapped<std::string>(instruction_sets(), instruction_set_name); })};
}

Argument declare_backend_folders(Arguments& arguments, OwnBackendOptions& options) {
  return arguments.add_list("--backend-folder DIR,...", options.folders,
                            "Folders with descriptions of backends, NAME.json (see docs/protocol.md)");
}

void declare_stepping(Arguments& arguments, RunOptions& options, const std::string& about_fps,
                      std::optional<Argument> needed) {
  const auto of_a_simulation = [&](Argument argument) {
    if (needed) argument.needs(*needed);
  };
  of_a_simulation(arguments
                      .add("--backend NAME|FILE", options.backend,
                           "Backend: a name (see mssim list backends), or the path of your own program, "
                           "with a slash (default: openmp)")
                      .offers(backend_names));
  of_a_simulation(declare_backend_folders(arguments, options.own_backends));
  of_a_simulation(declare_backend_limit(arguments, options.own_backends));
  of_a_simulation(arguments.add("--integrator NAME", options.integrator, "Integrator (default: semi-euler)")
                      .offers(integrator_names));
  of_a_simulation(
      arguments.add_number("--duration SECONDS", options.duration_s,
                           "Simulated time (default: 1); for a garment, the limit for it to settle "
                           "(default: 4)",
                           positive_number()));
  arguments.add_number("--fps N", options.fps, about_fps, positive_number());
  of_a_simulation(arguments.add_number("--dt SECONDS", options.dt_s, "Time step (default: the scene's)",
                                       number_between(1e-12, 1)));
  for (const Argument& argument : declare_execution(arguments, options.execution)) of_a_simulation(argument);
}

}  // namespace mssim
