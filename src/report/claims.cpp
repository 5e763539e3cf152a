#include <algorithm>
#include <array>

#include "integrators/all_integrators.h"
#include "output/tables/results.h"
#include "platform/files.h"
#include "report/report_internal.h"
#include "scene/fields/fields.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::size_t most_claims = 100;
constexpr std::array<std::string_view, 2> paper_words{"Hong et al. (2016)", "Vassilev"};
constexpr std::string_view too_few_rounds = "too few rounds for an interval";
/// Stands for the shipped garments, for which no numbers are published.
constexpr std::string_view table_of_garments = "figure6";
constexpr std::array<std::string_view, 2> device_words{"any", "GPU"}, of_words{"each", "average"};

/// The tables whose scenes can decide a claim.
std::vector<std::string_view> deciding_tables() {
  auto names = mapped<std::string_view>(published_table_kinds, &PublishedTableInfo::name);
  names.push_back(table_of_garments);
  return names;
}

void visit_test(FieldVisitor& fields, ClaimTest& test) {
  const std::vector<std::string_view> tables = deciding_tables();
  std::uint32_t table = 0;
  fields.choice({"scenes", "The table whose scenes decide the claim."}, Presence::required, tables, table);
  test.scenes = tables.at(table);
  fields.text({"fast", "The backend that is said to be faster."}, Presence::required, test.fast);
  fields.text({"slow", "The backend that it is compared with."}, Presence::required, test.slow);
  fields.choices({"integrators", "The integrators that decide (default: the paper's three)."},
                 mapped<std::string_view>(all_integrators, &Integrator::name), test.integrators);
  fields.text({"slow_integrator", "Integrator of `slow` (default: that of `fast`)."}, Presence::optional,
              test.slow_integrator);
  fields.text(
      {"gains_more_than", "If given, each ratio is a speed-up divided by the speed-up with this integrator."},
      Presence::optional, test.gains_more_than);
  visit_choice(fields, {"device", "The device on which OpenCL must have run (default: any)."},
               Presence::optional, device_words, test.on_gpu);
  visit_choice(fields, {"of", "Which ratios are tested: each (default), or their geometric mean."},
               Presence::optional, of_words, test.of_average);
  fields.number({"at_least", "The ratio that must be exceeded."}, test.at_least, above(0, 1000));
}

void visit_claim(FieldVisitor& fields, Claim& claim) {
  fields.text({"name", "Its name in mssim."}, Presence::required, claim.name);
  std::uint32_t paper = 0;
  fields.choice({"paper", "The paper that makes the claim."}, Presence::required, paper_words, paper);
  claim.paper = paper_words.at(paper);
  fields.text({"place", "Section, table, figure, equation."}, Presence::required, claim.place);
  fields.text({"says", "What the paper says, paraphrased in one line."}, Presence::required, claim.says);
  fields.text({"needs", "What a decision needs besides rows of the backends."}, Presence::optional,
              claim.needs);
  fields.object({"test", "How rows decide it; omitted if no rows can."}, Presence::optional,
                [&](FieldVisitor& test) { visit_test(test, claim.test.emplace()); });
}

void visit_claims(FieldVisitor& fields, std::vector<Claim>& claims) {
  fields.list({"claims", "What the papers say, and how it is tested."}, Presence::required, most_claims,
              "A claim.", [&](FieldVisitor& claim) { visit_claim(claim, claims.emplace_back()); });
}

/// Whether the paper's configuration of this backend has several threads.
bool has_threads(const PaperLegend& legend, std::string_view backend) {
  const auto* found = found_in(legend.backends, backend, &PaperLegend::Backend::name);
  return found && found->has_threads;
}

/// Whether the row ran on the hardware that the claim is about. OpenCL on this CPU is not a GPU, and one
/// thread is not several.
bool may_decide(const ResultRow* row, const ClaimTest& test, const PaperLegend& legend,
                const Provenance& provenance) {
  return row && (row->threads > 1 || !has_threads(legend, row->backend)) &&
         (!test.on_gpu || !is_this_processor(opencl_device(*row), provenance));
}

double quotient(double a, double b) { return a / b; }
RatioInterval quotient(const RatioInterval& a, const RatioInterval& b) {
  return {a.ratio / b.ratio, a.low / b.high, a.high / b.low, a.covers && b.covers};
}

/// The ratios of a test, for each scene and integrator with both times. `speedup` takes a scene and the
/// integrators of `fast` and `slow`; its Ratio is a number or has an interval.
template <class Ratio, class Speedup>
std::vector<Ratio> ratios_of(const ClaimTest& test, const PaperLegend& legend,
                             const std::vector<PaperScene>& scenes, const Speedup& speedup) {
  std::vector<Ratio> all;
  for (const auto& [name, paper_name, evaluations] : legend.integrators) {
    const bool is_asked = test.integrators.empty()
                              ? name == paper_name
                              : std::ranges::find(test.integrators, name) != test.integrators.end();
    if (!is_asked) continue;
    for (const PaperScene& scene : scenes) {
      const std::optional<Ratio> ratio =
          speedup(scene, name, test.slow_integrator.empty() ? name : test.slow_integrator);
      if (!ratio) continue;
      if (test.gains_more_than.empty())
        all.push_back(*ratio);
      else if (const std::optional<Ratio> base = speedup(scene, test.gains_more_than, test.gains_more_than))
        all.push_back(quotient(*ratio, *base));
    }
  }
  return all;
}

std::string times(double ratio) { return three_digits(ratio) + "×"; }

/// "1.30× to 2.12×", or one number if both are equal.
std::string range_of(double least, double most) {
  return times(least) == times(most) ? times(least) : times(least) + " to " + times(most);
}

std::string published_ratios(const ClaimTest& test, const PaperLegend& legend, const PublishedTable& table) {
  const std::string fast = legend.configuration_of(test.fast), slow = legend.configuration_of(test.slow);
  const auto speedup = [&](const PaperScene& scene, const std::string& of_fast,
                           const std::string& of_slow) -> std::optional<double> {
    if (fast == slow && of_fast == of_slow) return std::nullopt;  // the same time
    const auto fast_ms = table.ms(of_fast, fast, scene.nodes, scene.springs);
    const auto slow_ms = table.ms(of_slow, slow, scene.nodes, scene.springs);
    return fast_ms && slow_ms ? std::optional(*slow_ms / *fast_ms) : std::nullopt;
  };
  const auto all = ratios_of<double>(test, legend, table.scenes(), speedup);
  if (all.empty()) return {};
  const auto [least, most] = std::ranges::minmax(all);
  return fmt::format("{} ({}{})", range_of(least, most), pluralize(all.size(), "ratio"),
                     test.of_average ? ", geometric mean " + times(geometric_mean(all)) : "");
}

/// The scenes that decide a claim, and the measured rows.
struct Measured {
  const std::vector<PaperScene>& scenes;
  RowPointers rows;
  const PaperLegend& legend;
  const Provenance& provenance;
};

std::vector<RatioInterval> measured_ratios(const ClaimTest& test, const Measured& measured) {
  const auto speedup = [&](const PaperScene& scene, const std::string& of_fast,
                           const std::string& of_slow) -> std::optional<RatioInterval> {
    const ResultRow* fast = find_row(measured.rows, scene.name, test.fast, of_fast);
    const ResultRow* slow = find_row(measured.rows, scene.name, test.slow, of_slow);
    if (!may_decide(fast, test, measured.legend, measured.provenance) ||
        !may_decide(slow, test, measured.legend, measured.provenance))
      return std::nullopt;
    return times_as_fast(fast, slow);
  };
  return ratios_of<RatioInterval>(test, measured.legend, measured.scenes, speedup);
}

RatioInterval geometric_mean_of(const std::vector<RatioInterval>& ratios) {
  const auto mean = [&](double RatioInterval::*end) { return geometric_mean(mapped<double>(ratios, end)); };
  return {mean(&RatioInterval::ratio), mean(&RatioInterval::low), mean(&RatioInterval::high),
          std::ranges::all_of(ratios, &RatioInterval::covers)};
}

void judge_ratios(JudgedClaim& judged, const ClaimTest& test, const std::vector<RatioInterval>& all) {
  const std::vector<RatioInterval> tested = test.of_average ? std::vector{geometric_mean_of(all)} : all;
  const auto on_side = [&](int side) {
    return std::ranges::count_if(
        tested, [&](const RatioInterval& one) { return one.side_of(test.at_least) == side; });
  };
  const auto above = on_side(1), below = on_side(-1);
  judged.outcome = below > 0                     ? ClaimOutcome::not_held
                   : above == std::ssize(tested) ? ClaimOutcome::held
                                                 : ClaimOutcome::undecided;
  // Ratios without an interval decide nothing, and would widen the range; a mean has them all.
  std::vector<RatioInterval> shown = all;
  if (!test.of_average && std::ranges::any_of(all, &RatioInterval::covers))
    std::erase_if(shown, [](const RatioInterval& one) { return !one.covers; });
  const auto [least, most] = std::ranges::minmax(shown, {}, &RatioInterval::ratio);
  judged.measured = range_of(least.ratio, most.ratio);
  if (test.of_average)
    judged.measured += fmt::format(
        "; geometric mean {} ({})", times(tested.front().ratio),
        tested.front().covers ? range_of(tested.front().low, tested.front().high) : too_few_rounds);
  else
    judged.measured +=
        fmt::format("; {}: {} above {}, {} below, {} undecided", pluralize(all.size(), "ratio"), above,
                    times(test.at_least), below, std::ssize(all) - above - below);
  if (const auto without = std::ranges::count(all, false, &RatioInterval::covers);
      !test.of_average && without > 0)
    judged.measured += fmt::format(", {} of these with {}", without, too_few_rounds);
}

JudgedClaim judge_rows(const Claim& claim, const Measured& measured, std::string published = {}) {
  const ClaimTest& test = *claim.test;
  JudgedClaim judged{.claim = &claim, .published = std::move(published)};
  if (const auto ratios = measured_ratios(test, measured); !ratios.empty())
    judge_ratios(judged, test, ratios);
  else if (!claim.needs.empty())
    judged.measured = "needs " + claim.needs;
  else
    judged.measured = fmt::format(
        "needs verified rows of `{}`{}{}{}", test.fast,
        test.slow == test.fast ? "" : fmt::format(" and `{}`", test.slow),
        test.slow_integrator.empty()
            ? ""
            : fmt::format(" with {} and {}", listed(test.integrators, "or"), test.slow_integrator),
        has_threads(measured.legend, test.fast) ? " on several threads" : "");
  return judged;
}

/// The shipped garments in the rows, each once.
std::vector<PaperScene> shipped_garments(RowPointers rows) {
  std::vector<PaperScene> scenes;
  for (const ResultRow* row : rows)
    if (row->dressing && row->scene_as_shipped &&
        std::ranges::find(scenes, row->scene, &PaperScene::name) == scenes.end())
      scenes.push_back({row->scene, row->nodes, 0});
  return scenes;
}

}  // namespace

std::vector<Claim> claims_in(const std::filesystem::path& file, const std::string& text) {
  std::vector<Claim> claims;
  read_fields(file, text, [&](FieldVisitor& fields) { visit_claims(fields, claims); });
  return claims;
}

std::vector<Claim> published_claims() {
  const std::filesystem::path file = data_folder() / "published/claims.json";
  return claims_in(file, read_file(file));
}

std::string claims_schema() {
  std::vector<Claim> none;
  return json_schema(
      "Claims of the papers",
      "Statements of the two papers that a measurement can support or contradict (mssim report).",
      [&](FieldVisitor& fields) { visit_claims(fields, none); });
}

std::string_view name_of(ClaimOutcome outcome) {
  constexpr std::array<std::string_view, 4> names{"held", "not held", "undecided", "not testable here"};
  return names[static_cast<std::size_t>(outcome)];
}

std::vector<JudgedClaim> judge(const ReportFolder& folder, const ReportInput& input) {
  const Provenance provenance = folder.where_from();
  const std::vector<const ResultRow*> rows = pointers_to(folder.rows);
  std::vector<JudgedClaim> all;
  for (const PublishedTable& table : input.published) {
    const std::vector<PaperScene> scenes = table.scenes_of(folder.rows);
    if (scenes.empty()) continue;
    for (const Claim& claim : input.claims)
      if (claim.test && claim.test->scenes == table.info().name)
        all.push_back(judge_rows(claim, {scenes, rows, input.legend, provenance},
                                 published_ratios(*claim.test, input.legend, table)));
  }
  const bool of_hong = !all.empty();
  const std::vector<PaperScene> garments = shipped_garments(rows);
  const bool has_garments = !garments.empty();
  for (const Claim& claim : input.claims)
    if (claim.test && claim.test->scenes == table_of_garments && has_garments)
      all.push_back(judge_rows(claim, {garments, rows, input.legend, provenance}));
  for (const Claim& claim : input.claims)
    if (!claim.test && (claim.paper == paper_words.front() ? of_hong : has_garments))
      all.push_back({.claim = &claim, .measured = "needs " + claim.needs});
  std::ranges::stable_sort(
      all, {}, [](const JudgedClaim& judged) { return judged.outcome == ClaimOutcome::not_testable; });
  return all;
}

}  // namespace mssim
