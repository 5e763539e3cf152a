#include "output/guide/guide_tables.h"

#include <nlohmann/json.hpp>

#include "integrators/all_integrators.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Where the results lie that docs/guide.md speaks of. New ones only need to be put there: the tests print
/// the tables that the page should have then.
const char* const results = "results/guide/zen4/";
constexpr double error = 1e-3;

CsvTable results_of(const std::string& name) { return CsvTable(source_file(results + name)); }

/// The method of these names; null if the guide has none.
auto find_method(auto& guide, std::string_view integrator, std::string_view backend) {
  const auto found = std::ranges::find_if(guide.methods, [&](const GuidedMethod& method) {
    return method.integrator->name == integrator && method.backend->name == backend;
  });
  return found == guide.methods.end() ? nullptr : &*found;
}

/// The guides of guide.csv and guide-steps.csv, as far as costs at equal error ask for them.
std::vector<SceneGuide> measured_guides() {
  std::vector<SceneGuide> guides;
  const CsvTable points = results_of("guide.csv"), steps = results_of("guide-steps.csv");
  const auto guide_of = [&](const std::string& scene) -> SceneGuide& {
    const auto known = std::ranges::find(guides, scene, &SceneGuide::scene);
    if (known != guides.end()) return *known;
    guides.emplace_back().scene = scene;
    guides.back().wish.error = error;
    return guides.back();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    SceneGuide& guide = guide_of(points.text(i, points.column("scene")));
    const std::string& integrator = points.text(i, points.column("integrator"));
    const std::string& backend = points.text(i, points.column("backend"));
    GuidedMethod* method = find_method(guide, integrator, backend);
    if (method == nullptr)
      method = &guide.methods.emplace_back(GuidedMethod{find_integrator(integrator), find_backend(backend)});
    if (points.text(i, points.column("status")) != "ok") continue;
    WorkPoint& point = method->points.emplace_back();
    point.dt_s = points.number(i, points.column("dt_s"));
    point.seconds_a_step = points.number(i, points.column("ms_per_step")) / 1000;
    point.position_error = points.number(i, points.column("position_error"));
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    StepLimit& limit = guide_of(steps.text(i, steps.column("scene"))).limits.emplace_back();
    limit.integrator = find_integrator(steps.text(i, steps.column("integrator")));
    limit.measured.stable_s = steps.optional_number(i, steps.column("stable_dt_s")).value_or(0);
  }
  return guides;
}

std::optional<CostAtError> cost_of(const SceneGuide& guide, std::string_view integrator,
                                   std::string_view backend) {
  const GuidedMethod* method = find_method(guide, integrator, backend);
  return method != nullptr ? cost_at_error(*method, error) : std::nullopt;
}

double stable_step(const SceneGuide& guide, std::string_view integrator) {
  return std::ranges::find(guide.limits, find_integrator(integrator), &StepLimit::integrator)
      ->measured.stable_s;
}

std::string named(const GuidedMethod& method) {
  return method.backend->name == "openmp"
             ? std::string(method.integrator->name)
             : fmt::format("{} on {}", method.integrator->name, method.backend->name);
}

/// The cheapest method at equal error, and how much longer the runner-up takes.
Table cheapest_methods(const std::vector<SceneGuide>& guides) {
  Table table;
  for (const SceneGuide& guide : guides) {
    const Recommendation chosen = recommend(guide);
    const GuidedMethod &best = guide.methods[*chosen.best], &second = guide.methods[*chosen.runner_up];
    const auto cost = cost_at_error(best, error), other = cost_at_error(second, error);
    table.add({{"scene", guide.scene},
               {"cheapest", named(best)},
               {"step (ms)", 1000 * cost->dt_s},
               {"s per simulated second", cost->seconds_a_second},
               {"runner-up", named(second)},
               {"times as long", other->seconds_a_second / cost->seconds_a_second}});
  }
  return table;
}

/// What becomes of the integrators of Hong et al., and of a second thread with vectors.
Table compared_with_the_paper(const std::vector<SceneGuide>& guides) {
  Table table;
  for (const SceneGuide& guide : guides) {
    std::vector<std::pair<double, std::string>> order;
    for (const char* name : {"semi-euler", "midpoint", "rk4"})
      if (const auto cost = cost_of(guide, name, "openmp")) order.emplace_back(cost->seconds_a_second, name);
    std::ranges::sort(order);
    std::vector<std::string> names;
    for (const auto& [cost, name] : order) names.push_back(name);
    const auto serial = cost_of(guide, "verlet", "serial"), openmp = cost_of(guide, "verlet", "openmp");
    table.add({{"scene", guide.scene},
               {"of the paper's three, cheapest first", join(names, ", ")},
               {"explicit-euler's largest step over semi-euler's",
                stable_step(guide, "explicit-euler") / stable_step(guide, "semi-euler")},
               {"explicit-euler reaches 1e-3", cost_of(guide, "explicit-euler", "openmp") ? "yes" : "no"},
               {"`serial` over `openmp`, verlet",
                serial && openmp ? Cell(serial->seconds_a_second / openmp->seconds_a_second) : Cell()}});
  }
  return table;
}

/// Nodes of cloths that hold 60 frames per second with the step that keeps the error.
Table real_time() {
  const CsvTable frames = results_of("guide-frames.csv");
  const auto nodes = [&](std::string_view integrator, std::string_view backend) {
    for (std::size_t i = 0; i < frames.size(); ++i)
      if (frames.text(i, frames.column("integrator")) == integrator &&
          frames.text(i, frames.column("backend")) == backend &&
          frames.number(i, frames.column("frames_per_second")) == 60)
        return Cell(frames.count(i, frames.column("largest_nodes")));
    return Cell();
  };
  Table table;
  for (const char* integrator : {"verlet", "rk4", "semi-euler", "midpoint"})
    table.add({{"integrator", integrator},
               {"`openmp`", nodes(integrator, "openmp")},
               {"`serial`", nodes(integrator, "serial")}});
  return table;
}

/// What implicit methods make of a cloth, beside verlet: with their longest step, and at equal error.
Table implicit_methods(const SceneGuide& guide) {
  Table table;
  const double verlet = cost_of(guide, "verlet", "openmp")->seconds_a_second;
  const auto longest = [&](std::string_view integrator) -> const WorkPoint& {
    return *std::ranges::max_element(find_method(guide, integrator, "openmp")->points, {}, &WorkPoint::dt_s);
  };
  const auto add = [&](std::string_view name) {
    const auto cost = cost_of(guide, name, "openmp");
    table.add({{"integrator", name},
               {"largest stable step over verlet's", stable_step(guide, name) / stable_step(guide, "verlet")},
               {"longest step compared (ms)", 1000 * longest(name).dt_s},
               {"s per simulated second there", longest(name).seconds_a_second()},
               {"error there", two_digits(*longest(name).position_error)},
               {"time at 1e-3 over verlet's", cost ? Cell(cost->seconds_a_second / verlet) : Cell()}});
  };
  add("verlet");
  for (const Integrator& integrator : implicit_integrators) add(integrator.name);
  return table;
}

TEST(GuidePage, HasTheNumbersOfItsResults) {
  const std::string page = read_file(source_file("docs/guide.md"));
  const std::vector<SceneGuide> guides = measured_guides();
  for (const Table& table :
       {cheapest_methods(guides), compared_with_the_paper(guides), real_time(), implicit_methods(guides[0])})
    EXPECT_THAT(page, HasSubstr('\n' + markdown({table}) + '\n'));
  const nlohmann::json provenance =
      nlohmann::json::parse(read_file(source_file(results + std::string("provenance.json"))));
  EXPECT_THAT(page, HasSubstr(provenance["build"]["commit"].get<std::string>().substr(0, 7)));
}

TEST(GuideTables, HaveTheirColumnsWhereTheyWere) {
  SceneGuide guide;
  guide.wish.error = error;
  guide.methods.push_back({find_integrator("rk4"), find_backend("serial")});
  GuidedMethod& method = guide.methods.front();
  WorkPoint& point = method.points.emplace_back();
  point.dt_s = 1e-3;
  point.seconds_a_step = 1e-3;
  point.position_error = error;
  guide.limits.emplace_back().integrator = method.integrator;
  guide.sizes = {{method.integrator, method.backend, 1e-3, true, {{256, 1e-3}}, ""}};
  guide.recommendation = recommend(guide);
  const std::vector<SceneGuide> guides{guide};
  for (const ResultTable& table : guide_tables(guides, {})) {
    const std::string name = std::string(table.name) + ".csv";
    const CsvTable earlier = results_of(name), written(name, table_csv(table.data));
    const std::vector<std::string_view> known(earlier.header().begin(), earlier.header().end());
    EXPECT_NO_THROW(written.require_columns(known)) << name;
    if (written.size() == 1 && name == "guide.csv") {
      EXPECT_TRUE(written.truth(0, written.column("recommended")));
    }
    if (name == "guide-errors.csv") {
      EXPECT_EQ(written.number(0, written.column("dt_s")), 1e-3);
    }
  }
}

}  // namespace
}  // namespace mssim
