#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <variant>
#include <vector>

#include "application/bench/suites.h"
#include "application/prepared_scene.h"
#include "bench/job/job.h"
#include "bench/machine/provenance.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "output/folders/provenance_file.h"
#include "output/tables/suite_tables.h"
#include "platform/files.h"
#include "scene/builders.h"
#include "scene/scene_file.h"
#include "text/text.h"
#include "web/web.h"

namespace mssim {
namespace {

using nlohmann::json;

/// Numbers as the page reads them into a typed array. All machines that run mssim or WebGPU are
/// little-endian.
template <class Number>
std::string packed(const std::vector<Number>& numbers) {
  return base64({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)});
}

template <class Number>
std::vector<Number> numbers_of(std::span<const Vec3d> vectors) {
  std::vector<Number> numbers;
  for (const Vec3d& vector : vectors)
    for (const double number : {vector.x, vector.y, vector.z}) numbers.push_back(static_cast<Number>(number));
  return numbers;
}

/// Shapes of bodies, each once: many bodies of the paper are copies of nine.
class Shapes {
 public:
  /// The bodies of a system, which follow each other, as {shape, mass of a node in kg}.
  json bodies_of(const System& system) {
    std::vector<bool> is_inside(system.nodes() + 1, false);  // a spring passes between the node before and it
    for (const Spring& spring : system.springs)
      std::fill(is_inside.begin() + std::min(spring.first, spring.second) + 1,
                is_inside.begin() + std::max(spring.first, spring.second) + 1, true);
    json bodies = json::array();
    auto spring = system.springs.begin();
    for (std::uint32_t begin = 0, end = 1; begin < system.nodes(); begin = end++) {
      while (is_inside[end]) ++end;
      std::vector<std::uint32_t> ends;
      std::vector<float> rest;
      for (; spring != system.springs.end() && spring->first < end; ++spring) {
        ends.insert(ends.end(), {spring->first - begin, spring->second - begin});
        rest.push_back(spring->rest_length);
      }
      const json shape{{"nodes", end - begin}, {"ends", packed(ends)}, {"rest_lengths", packed(rest)}};
      const auto known = std::ranges::find(all_, shape);
      bodies.push_back({known - all_.begin(), system.node_mass[begin]});
      if (known == all_.end()) all_.push_back(shape);
    }
    return bodies;
  }
  json all() const { return all_; }

 private:
  std::vector<json> all_;
};

/// Everything of a system but its start.
json laws_of(const System& system, Shapes& shapes) {
  json laws{{"nodes", system.nodes()},
            {"gravity", system.gravity},
            {"viscous_damping", system.viscous_damping},
            {"floor", {system.floor.height, system.floor.restitution, system.floor.friction}},
            {"materials", mapped<json>(system.materials,
                                       [](const SpringMaterial& material) { return numbers_of(material); })},
            {"pins", system.pins},
            {"mean_rest_length", mean_rest_length(system)},
            {"rounding_energy_j", energy_in_motion(system, system.start, Energy())}};
  if (const auto* grid = std::get_if<GridPatch>(&system.topology)) {
    json rest = json::array();
    for (std::size_t kind = 0; kind < grid_spring_kinds.size(); ++kind)
      rest.push_back(grid->rest_length(static_cast<GridSpringKind>(kind)));
    laws["grid"] = {{"rows", grid->rows},
                    {"columns", grid->columns},
                    {"rest_lengths", rest},
                    {"node_mass", system.node_mass.front()}};
  } else {
    laws["bodies"] = shapes.bodies_of(system);
  }
  return laws;
}

json start_of(const System& system) {
  return {{"position", packed(numbers_of<float>(system.start.position))},
          {"velocity", packed(numbers_of<float>(system.start.velocity))}};
}

/// A cloth's start is computed by the page, which compares a few nodes: 350,000 of them would be 11 MB.
json ripple_of(const ClothSpec& cloth, const System& system) {
  json nodes = json::array();
  for (std::size_t node = 1; node < system.nodes(); node += system.nodes() / 16) {
    const Vec3d &x = system.start.position[node], &v = system.start.velocity[node];
    nodes.push_back({node, {x.x, x.y, x.z}, {v.x, v.y, v.z}});
  }
  return {{"spacing", cloth.spacing_m},
          {"ceiling", cloth.ceiling_height_m},
          {"height", cloth.ripple.height_m},
          {"wavelength", cloth.ripple.wavelength_m},
          {"speed", cloth.ripple.speed_m_per_s},
          {"in_plane_share", ripple_in_plane_share},
          {"phases", ripple_phases},
          {"some_nodes", nodes}};
}

/// What the verification of each integrator needs (bench/verification/verification.h).
json checks_of(const System& system, double dt_s, Shapes& shapes) {
  json checks = json::object();
  for (const Integrator* integrator : all_integrators) {
    if (is_implicit(*integrator)) continue;
    const SecondStretch stretch = run_second_stretch(system, *integrator, dt_s);
    checks[std::string(integrator->name)] = {
        {"steps", comparable_steps(system, *integrator, dt_s, verification_steps)},
        {"tolerance_of_a_step", position_tolerance(system, *integrator, 1)},
        {"second",
         {{"steps", stretch.steps},
          {"tolerance", stretch.tolerance},
          {"floor_height", stretch.system.floor.height},
          {"start", start_of(stretch.system)},
          {"position", packed(numbers_of<double>(stretch.state.position))}}}};
    checks["second_system"] = laws_of(stretch.system, shapes);
  }
  return checks;
}

/// The published times of a scene: by the paper's name of an integrator, then by configuration.
json published_of(const PreparedScene& scene, std::span<const PublishedTable> published) {
  json times = json::object();
  for (const PublishedTable& table : published)
    for (const Integrator& integrator : integrators)
      for (const PaperConfiguration& configuration : paper_configurations)
        if (const auto ms = table.ms(integrator.name, configuration.name, scene.counts.nodes,
                                     scene.counts.springs_published))
          times[std::string(integrator.name)][std::string(configuration.name)] = *ms;
  return times;
}

json scene_of(const std::string& name, std::span<const PublishedTable> published, Provenance& provenance,
              Shapes& shapes) {
  const PreparedScene scene = prepare_scene(find_scene(name));
  add_scene(provenance, name, scene.spec.source);
  json result = laws_of(scene.system, shapes);
  const auto* cloth = std::get_if<ClothSpec>(&scene.spec.content);
  result.update({{"name", name},
                 {"kind", cloth != nullptr ? "cloth" : "bodies"},
                 {"dt", scene.dt_s},
                 {"note", scene.note},
                 {"springs_unique", scene.counts.springs_unique},
                 {"springs_published", scene.counts.springs_published.value_or(0)},
                 {"start", cloth != nullptr ? ripple_of(*cloth, scene.system) : start_of(scene.system)},
                 {"checks", checks_of(scene.system, scene.dt_s, shapes)},
                 {"published", published_of(scene, published)}});
  return result;
}

json integrators_json() {
  json table = json::array();
  for (const Integrator* integrator : all_integrators) {
    if (is_implicit(*integrator)) continue;
    json stages = json::array();
    for (const Stage& stage : std::span(integrator->stages).first(integrator->stage_count)) {
      json assignments = json::array();
      for (const Assignment& assignment : std::span(stage.assignments).first(assignment_count(stage))) {
        json terms = json::array();
        for (const Term& term : std::span(assignment.terms).first(term_count(assignment)))
          terms.push_back({term.coefficient, term.dt_power, name_of(term.slot)});
        assignments.push_back({{"out", name_of(assignment.out)}, {"terms", terms}});
      }
      stages.push_back({{"gather", index(stage.gather)}, {"assignments", assignments}});
    }
    table.push_back({{"name", integrator->name},
                     {"paper_name", integrator->paper_name},
                     {"ahead", integrator->ahead},
                     {"stages", stages}});
  }
  return table;
}

/// A module of WebAssembly; null if mssim was built without a compiler for it (cmake/wasm_module.cmake).
json module_text(const char* name) {
  const std::filesystem::path file = data_folder() / name;
  return std::filesystem::exists(file) ? json(base64(read_file(file))) : json();
}

json page_data() {
  Provenance provenance;
  provenance.build = build_info();
  provenance.threads = 1;
  const std::vector<PublishedTable> published = published_tables();
  Shapes shapes;
  json scenes = json::array(), stencil = json::array(), slots = json::array(), laws = json::array(),
       configurations = json::object();
  for (const char* suite : {"table1", "table3"})
    for (const std::string& name : scenes_of_suite(suite, true))
      scenes.push_back(scene_of(name, published, provenance, shapes));
  for (const GridSpring& spring : grid_stencil)
    stencil.push_back({spring.rows, spring.columns, static_cast<int>(spring.kind)});
  for (std::size_t slot = 0; slot < memory_slots; ++slot) slots.push_back(slot_names[slot]);
  for (const BrowserBackend& backend : browser_backends)
    configurations[std::string(backend.name)] = backend.paper_configuration;
  for (const char* file : {"spring_law.h", "node_laws.h"})
    laws.push_back(read_file(data_folder() / "kernels" / file));
  return {{"laws", laws},
          {"spring_constants", mapped<json>(spring_constants, &SpringConstantInfo::name)},
          {"memory_slots", slots},
          {"integrators", integrators_json()},
          {"stencil", stencil},
          {"scenes", scenes},
          {"shapes", shapes.all()},
          {"columns", mapped<json>(result_columns, &ResultColumn::name)},
          {"wasm", module_text("spring_list.wasm")},
          {"wasm_threads", module_text("spring_list_threads.wasm")},
          {"configurations", configurations},
          {"paper_device", paper_device},
          {"energy_tolerance", energy_tolerance},
          {"verification_steps", verification_steps},
          {"steps_between_looks", steps_between_looks},
          {"least_clock_steps", least_clock_steps},
          {"most_warm_up_trials", most_warm_up_trials},
          {"max_sample_steps", max_sample_steps},
          {"provenance", json::parse(provenance_text(provenance))}};
}

void replace(std::string& text, std::string_view mark, std::string_view by) {
  text.replace(text.find(mark), mark.size(), by);
}

}  // namespace

std::string web_page(bool served) {
  const std::filesystem::path folder = data_folder() / "browser";
  std::string page = read_file(folder / "page.html");
  for (const char* file : {"style.css", "simulate.js", "measure.js", "page.js"})
    replace(page, fmt::format("/* {} */", file), read_file(folder / file));
  // Nothing may end the element; in JSON a "<" stands in texts alone.
  std::string data;
  json values = page_data();
  values["served"] = served;
  for (const char character : values.dump()) character == '<' ? data += "\\u003c" : data += character;
  replace(page, "/* data */", data);
  return page;
}

}  // namespace mssim
