#include "application/guide_run.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "application/console.h"
#include "application/outputs.h"
#include "application/prepared_scene.h"
#include "output/folders/result_folder.h"
#include "output/guide/guide_tables.h"
#include "output/tables/table.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// With that many nodes along a side; its text says so too.
SceneSpec with_side(SceneSpec spec, std::uint32_t side) {
  auto& cloth = std::get<ClothSpec>(spec.content);
  const double lowest = spec.floor.height + cloth.ripple.height_m;  // the cloth starts above the floor
  cloth.ceiling_height_m = lowest + (cloth.ceiling_height_m - lowest) * (side - 1) / (cloth.rows - 1);
  cloth.rows = cloth.columns = side;
  if (cloth.pins) cloth.pins->row = 0;
  nlohmann::json text = nlohmann::json::parse(spec.source);
  nlohmann::json& fields = text.at("cloth");
  fields["rows"] = fields["columns"] = side;
  fields["ceiling_height_m"] = cloth.ceiling_height_m;
  if (cloth.pins) fields["pins"]["row"] = 0;
  spec.source = text.dump();
  return spec;
}

/// Makes square cloths of the same springs, masses, spacing, pins and ripple as this one. In lengths of a
/// side, the lowest points of their ripples are as high above the floor as its. None where the scene is no
/// cloth.
ClothMaker cloth_family(const SceneSpec& spec) {
  const auto* cloth = std::get_if<ClothSpec>(&spec.content);
  if (cloth == nullptr || cloth->rows < 2) return {};
  return [spec, folder = std::make_shared<TemporaryFolder>()](std::uint32_t side) {
    const SceneSpec one = with_side(spec, side);
    FamilyCloth made{build_system(one), folder->path() / fmt::format("{}.json", side)};
    write_file_atomically(made.file, one.source);
    return made;
  };
}

/// Whether both are cloths of one family: the same but for their size.
bool same_family(const SceneSpec& a, const SceneSpec& b) {
  const auto *one = std::get_if<ClothSpec>(&a.content), *other = std::get_if<ClothSpec>(&b.content);
  if (one == nullptr || other == nullptr) return false;
  return one->spacing_m == other->spacing_m &&
         one->areal_density_kg_per_m2 == other->areal_density_kg_per_m2 && one->springs == other->springs &&
         a.gravity_m_per_s2 == b.gravity_m_per_s2 && a.viscous_damping_per_s == b.viscous_damping_per_s;
}

std::vector<SceneSpec> asked_scenes(const GuideOptions& options) {
  std::vector<SceneSpec> scenes;
  for (const std::string& name : options.scenes) {
    SceneSpec spec = find_scene(name);
    if (std::holds_alternative<GarmentSpec>(spec.content))
      throw UsageError(spec.name +
                       " is a garment, which mssim guide does not measure: name a cloth or bodies");
    const bool known = std::ranges::any_of(scenes, [&](const SceneSpec& other) {
      std::error_code error;
      return other.name == spec.name && std::filesystem::equivalent(other.file, spec.file, error);
    });
    if (!known) scenes.push_back(std::move(spec));
  }
  require_distinct_names(scenes);
  if (scenes.empty()) throw UsageError("there is nothing to measure: name a --scene");
  return scenes;
}

/// The folder, without results that are to stay; null where results are only printed.
std::unique_ptr<ResultFolder> result_folder(const GuideOptions& options, const Provenance& provenance) {
  if (options.folder.empty()) {
    if (options.overwrite) throw UsageError("--overwrite needs the folder of an earlier run: give --out too");
    return nullptr;
  }
  auto folder = std::make_unique<ResultFolder>(options.folder, provenance, TableMaker());
  if (folder->has_results()) {
    if (!options.overwrite)
      throw UsageError(options.folder +
                       " already holds results: give another --out, or --overwrite to "
                       "replace them");
    folder->replace_results();
  }
  folder->begin();
  return folder;
}

/// Throws Unavailable for a backend that was requested by name and cannot run here.
void require_available(const GuideOptions& options, const std::vector<const BackendInfo*>& backends,
                       const ExecutionOptions& execution) {
  if (options.backends.empty()) return;
  for (const BackendInfo* info : backends)
    if (const std::string reason = unavailable_reason(*info, execution); !reason.empty())
      throw Unavailable("{}: {}", info->name, reason);
}

void print(const SceneGuide& guide) {
  std::cout << guide.scene << '\n';
  const bool has_errors = guide.trusted.failure.empty();
  if (!has_errors) std::cout << "No errors were measured: " << guide.trusted.failure << ".\n";
  for (const std::string& sentence : guide.recommendation.sentences) std::cout << sentence << '\n';
  if (!has_errors) return;
  for (const std::string& sentence : what_was_measured(guide)) std::cout << sentence << '\n';
  std::cout << '\n' << to_text(guide_summary(guide)) << '\n';
  for (const std::string& sentence : about_trusted_state(guide.trusted)) std::cout << sentence << '\n';
}

/// A scene gets so much even where those before it have overrun the whole, s.
constexpr double least_scene_s = 1;

/// What can be known before anything is measured.
struct GuidePlan {
  std::vector<SceneSpec> scenes;
  GuideRequest request;  ///< what is the same for all scenes
  double seconds = 0;    ///< wall time for all scenes
};

/// `seconds`: wall time for this scene.
SceneGuide measured(const GuidePlan& plan, std::size_t number, double seconds, ProgressLine& progress,
                    const StopRequest& stop) {
  const SceneSpec& spec = plan.scenes[number];
  const PreparedScene scene = prepare_scene(spec);
  warn_of_note(scene);
  GuideRequest request = plan.request;
  request.execution.scene = spec.name;
  request.execution.scene_file = spec.file;
  request.system = &scene.system;
  request.seconds = seconds;
  // Once for every family.
  const auto earlier = plan.scenes.begin() + static_cast<std::ptrdiff_t>(number);
  if (std::none_of(plan.scenes.begin(), earlier, [&](const SceneSpec& s) { return same_family(s, spec); }))
    request.make_cloth = cloth_family(spec);
  return guide_scene(request, {.progress = [&](const std::string& activity,
                                               double done) { progress.update(activity, done); },
                               .stop = [&] { return stop.requested(); }});
}

std::string sentence_of(const SceneGuide& guide, const GuidedMethod& method) {
  return fmt::format("{}, {}, {}: {}", guide.scene, method.backend->name, method.integrator->name,
                     method.ending.status());
}

/// Scenes for which the time was too short, and what programs have failed with. `scenes`: how many share the
/// time.
std::vector<std::string> failures(const std::vector<SceneGuide>& guides, std::size_t scenes) {
  std::vector<std::string> sentences;
  for (const SceneGuide& guide : guides) {
    if (const auto& needed_s = guide.recommendation.needed_s)
      sentences.push_back(
          fmt::format("{}: nothing is recommended, because the time is not enough: give --time-budget {} or "
                      "more",
                      guide.scene, decimal(*needed_s * static_cast<double>(scenes))));
    for (const GuidedMethod& method : guide.methods)
      if (method.ending.lack == Lack::failed) sentences.push_back(sentence_of(guide, method));
  }
  return sentences;
}

/// Whether the backend runs the method here, and can be timed.
bool can_run(const GuidedMethod& method) {
  const Lack lack = method.ending.lack;
  return lack != Lack::unsupported && lack != Lack::unavailable && lack != Lack::not_timed;
}

/// Methods whose backend or integrator was asked for by name, and could run on a scene with none.
std::vector<std::string> missed(const std::vector<SceneGuide>& guides, const GuideOptions& options) {
  const bool names_integrators =
      !options.integrators.empty() && options.integrators != std::vector<std::string>{"all"};
  std::vector<std::string> sentences;
  for (const SceneGuide& guide : guides)
    for (const GuidedMethod& method : guide.methods) {
      const auto nothing_runs = [&](auto GuidedMethod::*member) {
        return std::ranges::none_of(guide.methods, [&](const GuidedMethod& other) {
          return other.*member == method.*member && can_run(other);
        });
      };
      if ((!options.backends.empty() && nothing_runs(&GuidedMethod::backend)) ||
          (names_integrators && nothing_runs(&GuidedMethod::integrator)))
        sentences.push_back(sentence_of(guide, method));
    }
  return sentences;
}

void print_plan(const GuidePlan& plan) {
  Table table;
  for (const SceneSpec& spec : plan.scenes)
    table.add({{"scene", spec.name},
               {"integrators", plan.request.integrators.size()},
               {"backends", plan.request.backends.size()},
               {"expected_s", plan.seconds / static_cast<double>(plan.scenes.size())}});
  std::cout << to_text(table) << "about " << three_digits(plan.seconds) << " s in all\n";
}

}  // namespace

std::vector<const BackendInfo*> guide_backends() {
  std::vector<const BackendInfo*> rows;
  for (const BackendInfo& row : backends())
    if (row.role != BackendRole::as_published) rows.push_back(&row);
  return rows;
}

int run_guide(const GuideOptions& options) {
  GuidePlan plan;
  GuideRequest& request = plan.request;
  request.wish = options.wish;
  request.longest_horizon_s = options.horizon_s;
  BackendChoice choice(table_backends(), options.own_backends, options.scenes);
  request.backends = options.backends.empty() ? guide_backends() : choice.require_all(options.backends);
  require_use_of_options(options.execution, request.backends);
  request.integrators = chosen_integrators(options.integrators, guide_integrators);
  plan.scenes = asked_scenes(options);
  request.execution = complete(options.execution);
  plan.seconds = options.time_budget_s.value_or(usual_guide_s * static_cast<double>(plan.scenes.size()));
  if (options.dry_run) {
    print_plan(plan);
    return exit_ok;
  }
  require_available(options, request.backends, request.execution);
  const bool uses_device = std::ranges::any_of(request.backends, &BackendInfo::uses_device);
  Provenance provenance = run_provenance(request.execution.threads, uses_device);
  add_execution(provenance, choice.own(), request.execution);
  for (const SceneSpec& spec : plan.scenes) add_scene(provenance, spec.name, spec.source);
  const std::unique_ptr<ResultFolder> folder = result_folder(options, provenance);
  for (const std::string& noise : provenance.noise) tell("noise: {}", noise);
  if (uses_device) tell_of_opencl();

  std::vector<SceneGuide> guides;
  bool written = false;
  StopRequest stop;
  {
    ProgressLine progress(std::vector<double>(plan.scenes.size(), 1));
    const Stopwatch watch;
    for (std::size_t number = 0; number < plan.scenes.size() && !stop.requested(); ++number) {
      progress.begin_scene(plan.scenes[number].name);
      // What a scene leaves goes to those after it, and what it overruns they make good.
      const double share =
          (plan.seconds - watch.seconds()) / static_cast<double>(plan.scenes.size() - number);
      try {
        guides.push_back(measured(plan, number, std::max(share, least_scene_s), progress, stop));
      } catch (const Interrupted& interrupted) {
        // A wait for a program; the guides of earlier scenes are kept.
        note_ending_signal(interrupted.signal);
        break;
      }
      // A guide that was stopped before it had a point replaces nothing.
      if (!folder || (stop.requested() && !guides.back().has_points())) continue;
      folder->write(guide_tables(guides, provenance));
      written = true;
    }
  }
  for (const SceneGuide& guide : guides) {
    if (&guide != &guides.front()) std::cout << '\n';
    print(guide);
  }
  if (written) tell("results are in {}", escaped(options.folder));
  if (folder && !written)
    tell("nothing was measured yet; {} in {}",
         folder->has_results() ? "earlier results are still" : "there are no results",
         escaped(options.folder));
  stop.throw_if_requested();
  if (const std::vector<std::string> failed = failures(guides, plan.scenes.size()); !failed.empty()) {
    tell_first(failed);
    return exit_not_verified;
  }
  const std::vector<std::string> unavailable = missed(guides, options);
  tell_first(unavailable);
  return unavailable.empty() ? exit_ok : exit_unavailable;
}

}  // namespace mssim
