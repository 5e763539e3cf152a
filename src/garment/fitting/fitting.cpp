#include "garment/fitting/fitting.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "garment/layers/cloth_contacts.h"
#include "laws/host_laws.h"
#include "statistics/statistics.h"

namespace mssim {
namespace {

/// Whether enough nodes have moved little. A node that is not finite has not.
bool rests(const State& before, const State& after, const SettlingRule& rule) {
  std::size_t resting = 0;
  for (std::size_t i = 0; i < after.position.size(); ++i)
    if (length(after.position[i] - before.position[i]) < rule.distance) ++resting;
  return static_cast<double>(resting) > rule.fraction * static_cast<double>(after.position.size());
}

/// Delivers the frames of a dressing in their order.
struct FrameDelivery {
  const DressingFrames& frames;
  std::int64_t next = 0;

  /// Steps after which the next frame is due; none without a receiver.
  std::optional<std::int64_t> due() const {
    return frames.on_frame ? std::optional(frames.grid.step_of(next)) : std::nullopt;
  }
  void deliver(const State& state, std::int64_t iterations) {
    if (!frames.on_frame) return;
    frames.on_frame(state, iterations);
    ++next;
  }
};

/// Steps from `done` to `end`, and delivers the frames due before `end`.
void step_through(DressingBackend& backend, std::int64_t done, std::int64_t end, FrameDelivery& frames) {
  const auto step_to = [&](std::int64_t step) {
    while (done < step) {
      const auto count = std::min(step - done, most_dressing_steps_at_once);
      backend.step(static_cast<int>(count));
      done += count;
      if (frames.frames.on_steps) frames.frames.on_steps();
    }
  };
  for (auto due = frames.due(); due && *due < end; due = frames.due()) {
    step_to(*due);
    frames.deliver(backend.state(), done);
  }
  step_to(end);
}

double largest_gap(const Garment& garment, const std::vector<Vec3d>& position) {
  double largest = 0;
  for (const Joint& joint : garment.joints) {
    largest = std::max(largest, length(joint_gap(position[joint.node], position[joint.edge_first],
                                                 position[joint.edge_second], joint.edge_share)));
  }
  return largest;
}

void measure_side_distance(const CloseCloth& close, const std::vector<Vec3d>& position, const FitBody& body,
                           Fit& fit) {
  std::vector<Vec3d> points;
  for (const std::uint32_t node : close.nodes)
    if (position[node].y >= close.lowest && position[node].y <= close.highest)
      points.push_back(position[node]);
  if (points.empty()) return;
  const std::vector<double> distances = body.distances(points, close.lowest, close.highest);
  const auto farthest = std::ranges::max_element(distances);
  fit.side_distance = *farthest;
  fit.side_distance_height = points[static_cast<std::size_t>(farthest - distances.begin())].y;
}

/// Whether the elongation of a spring of the 12-neighbour stencil counts: it spans a single cell. Bending
/// springs, two cells long, may change length by bending.
bool is_structural_or_shear(const Garment& garment, const Spring& spring) {
  const GarmentPanel& panel = garment.panel_of(spring.first);
  const auto apart = [](std::uint32_t a, std::uint32_t b) { return a < b ? b - a : a - b; };
  return apart(panel.row_of(spring.first), panel.row_of(spring.second)) <= 1 &&
         apart(panel.column_of(spring.first), panel.column_of(spring.second)) <= 1;
}

std::vector<double> elongations(const System& system, const Garment& garment,
                                const std::vector<Vec3d>& position) {
  std::vector<double> elongations;
  for (const Spring& spring : system.springs)
    if (is_structural_or_shear(garment, spring))
      elongations.push_back(length(position[spring.second] - position[spring.first]) / spring.rest_length -
                            1);
  return elongations;
}

/// Mean height of nodes, one or more, above their place in the pattern.
double mean_rise(const Garment& garment, const std::vector<Vec3d>& position,
                 const std::vector<std::uint32_t>& nodes) {
  double rise = 0;
  for (const std::uint32_t node : nodes) rise += position[node].y - garment.flat[node].y;
  return rise / static_cast<double>(nodes.size());
}

/// The mean rise of the upper edges of a layer's panels, of the layer with the largest deviation.
double upper_edge_rise(const Garment& garment, const std::vector<Vec3d>& position) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> edges;
  for (const GarmentPanel& panel : garment.panels)
    for (std::uint32_t column = 0; column < panel.columns; ++column)
      edges[panel.layer].push_back(panel.node(panel.rows - 1, column));
  double farthest = 0;
  for (const auto& [layer, nodes] : edges) {
    const double rise = mean_rise(garment, position, nodes);
    if (!(std::abs(rise) <= std::abs(farthest))) farthest = rise;
  }
  return farthest;
}

/// The closed rows of a garment (Fit::rows) as loops of nodes. Each row of a panel is in one of them at
/// least, if it is closed.
std::vector<std::vector<std::uint32_t>> closed_rows(const Garment& garment) {
  std::multimap<std::uint32_t, std::uint32_t> sewn_to;
  for (const Joint& joint : garment.joints) {
    const std::uint32_t other = joint.edge_share < 0.5 ? joint.edge_first : joint.edge_second;
    sewn_to.emplace(joint.node, other);
    sewn_to.emplace(other, joint.node);
  }
  // The shortest way from a row to its panel, as left ends of rows; empty if there is none.
  const auto way_around = [&](std::uint32_t start) -> std::vector<std::uint32_t> {
    std::vector<std::vector<std::uint32_t>> ways{{start}};
    std::set<const GarmentPanel*> reached;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const std::uint32_t left = ways[i].back(), right = left + garment.panel_of(left).columns - 1;
      for (auto [to, end] = sewn_to.equal_range(right); to != end; ++to) {
        const GarmentPanel& next = garment.panel_of(to->second);
        if (next.column_of(to->second) != 0) continue;  // no left end
        if (&next == &garment.panel_of(start)) return ways[i];
        if (!reached.insert(&next).second) continue;
        ways.push_back(ways[i]);
        ways.back().push_back(to->second);
      }
    }
    return {};
  };
  std::set<std::uint32_t> in_a_loop;  // rows, by their left ends
  std::vector<std::vector<std::uint32_t>> loops;
  for (const GarmentPanel& panel : garment.panels)
    for (std::uint32_t row = 0; row < panel.rows; ++row) {
      if (in_a_loop.contains(panel.node(row, 0))) continue;
      const std::vector<std::uint32_t> rows = way_around(panel.node(row, 0));
      if (rows.empty()) continue;
      in_a_loop.insert(rows.begin(), rows.end());
      std::vector<std::uint32_t>& loop = loops.emplace_back();
      for (auto left = rows.rbegin(); left != rows.rend(); ++left)
        for (std::uint32_t column = garment.panel_of(*left).columns; column-- > 0;)
          loop.push_back(*left + column);
    }
  return loops;
}

/// The winding number of a loop around a vertical axis.
int turns_around(const std::vector<std::uint32_t>& loop, const std::vector<Vec3d>& position,
                 const Vec3d& axis) {
  double angle = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3d from = position[loop[i]] - axis, to = position[loop[(i + 1) % loop.size()]] - axis;
    angle += std::atan2(from.z * to.x - from.x * to.z, from.x * to.x + from.z * to.z);
  }
  return static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
}

/// A likely cause of a number out of bounds, and a remedy with the keys of scene files. Keys of jeans are
/// said to be theirs if other garments have the number, too.
struct Diagnosis {
  std::string_view happened, remedy;
};

constexpr Diagnosis pierced{"the body comes through", "a larger skin_m or more nodes"};
constexpr Diagnosis stretched{"the cloth is stretched",
                              "a wider garment (of jeans: hip_ease_m, waist_ease_m) or stiffer cloth"};

/// Units of a number.
struct Unit {
  double per_unit;          ///< factor to the unit at the end of the number's name
  std::string_view spoken;  ///< unit in a sentence, with a leading space
  double per_spoken;        ///< factor to the unit in a sentence
};
constexpr Unit plain{1, "", 1}, millimetres{1e3, " mm", 1e3}, per_cent{1, " %", 100};

/// None if the garment has no such number.
template <auto member>
std::optional<double> of_fit(const Fit& fit) {
  return std::optional<double>(fit.*member);
}

/// A row of the TABLE of a fit's numbers.
struct FitNumber {
  std::string_view name;
  std::optional<double> (*value)(const Fit& fit);
  Unit unit = plain;
  double FitBounds::*bound = nullptr;  ///< on the magnitude; null: none
  std::string_view what{};             ///< in a sentence
  Diagnosis too_large{};
  Diagnosis too_small{};  ///< if there is one, the bound holds in both directions
};

constexpr auto numbers = std::to_array<FitNumber>({
    {"largest_gap_mm",
     of_fit<&Fit::largest_gap>,
     millimetres,
     &FitBounds::largest_gap,
     "the largest gap of a seam",
     {"a seam gapes", "a larger closing_share, or a wider garment (of jeans: hip_ease_m, waist_ease_m)"}},
    {"nodes_inside", of_fit<&Fit::nodes_inside>},
    {"deepest_node_mm", of_fit<&Fit::deepest_node>, millimetres, &FitBounds::deepest,
     "the deepest node inside the body", pierced},
    {"deepest_face_mm", of_fit<&Fit::deepest_face_sample>, millimetres, &FitBounds::deepest,
     "the deepest point of a face inside the body", pierced},
    {"elongation_50", of_fit<&Fit::elongation_50>},
    {"elongation_99", of_fit<&Fit::elongation_99>, per_cent, &FitBounds::elongation_99,
     "the 99th percentile of elongations", stretched},
    {"elongation_999", of_fit<&Fit::elongation_999>, per_cent, &FitBounds::elongation_999,
     "the 99.9th percentile of elongations", stretched},
    {"elongation_max", of_fit<&Fit::elongation_max>},
    {"upper_edge_rise_mm",
     of_fit<&Fit::upper_edge_rise>,
     millimetres,
     &FitBounds::upper_edge_shift,
     "the distance of the upper edge from its place in the pattern",
     {"the garment was pushed up",
      "a higher waist or more ease there (of jeans: waist_height_m, waist_ease_m)"},
     {"the garment slid down",
      "a lower waist or less ease there (of jeans: waist_height_m, waist_ease_m), more friction, or a longer "
      "step"}},
    {"crotch_rise_mm",
     of_fit<&Fit::crotch_rise>,
     millimetres,
     &FitBounds::crotch_shift,
     "the distance of the crotch from its place in the pattern",
     {"the crotch was drawn up", "more crotch_ease_m"},
     {"the crotch hangs low", "less crotch_ease_m, or a lower waist (waist_height_m)"}},
    {"rows", of_fit<&Fit::rows>},
    {"rows_astray",
     of_fit<&Fit::rows_astray>,
     plain,
     &FitBounds::rows_astray,
     "the number of rows that do not go once around their limb",
     {"the garment does not go around the body", "more nodes, or a body whose legs are further apart"}},
    {"crossings",
     of_fit<&Fit::crossings>,
     plain,
     &FitBounds::crossings,
     "the number of places where layers of the cloth cross",
     {"layers passed through each other",
      "layers that touch (\"layers\"), a larger thickness_m or more nodes"}},
    {"side_distance_mm",
     of_fit<&Fit::side_distance>,
     millimetres,
     &FitBounds::side_distance,
     "the largest distance between body and side seams from hip to thigh",
     {"the garment stands off at the sides",
      "less hip_ease_m, a hip_height_m where the body is widest, or more nodes"}},
    {"side_distance_height_m", of_fit<&Fit::side_distance_height>},
});

/// NaN is within no bound.
bool is_within(const FitNumber& number, double value, const FitBounds& bounds) {
  return std::abs(value) <= bounds.*number.bound;
}

bool has_sign(const FitNumber& number) { return !number.too_small.happened.empty(); }

/// The bound as text, in a unit of which the number's own has `per_unit`.
std::string shown_bound(const FitNumber& number, const FitBounds& bounds, double per_unit) {
  return fmt::format("{}{:g}", has_sign(number) ? "±" : "", bounds.*number.bound * per_unit);
}

}  // namespace

DressingResult dress(DressingBackend& backend, const System& system, double dt_s, const SettlingRule& rule,
                     const OnWindow& on_window, const DressingFrames& frames) {
  const std::int64_t window = std::max(1LL, std::llround(rule.window_s / dt_s));
  const std::int64_t longest = std::llround(rule.longest_s / dt_s);
  backend.set_state(system.start);
  DressingResult result;
  result.state = system.start;
  FrameDelivery delivery{frames};
  delivery.deliver(result.state, 0);
  bool goes_on = longest > 0;
  while (goes_on) {
    const bool was_draping = backend.progress().draping;
    const std::int64_t end = std::min(result.iterations + window, longest);
    const bool whole_window = end - result.iterations == window;
    step_through(backend, result.iterations, end, delivery);
    result.iterations = end;
    State state = backend.state();
    if (backend.progress().draping) result.seamed_at = backend.progress().seamed_at;
    // A window that started with open seams, or was cut short, does not show whether a sewn garment rests.
    result.settled = was_draping && whole_window && rests(result.state, state, rule);
    result.state = std::move(state);
    goes_on = on_window(result.state, result.iterations) && !result.settled && result.iterations < longest;
    if (!goes_on || delivery.due() == result.iterations) delivery.deliver(result.state, result.iterations);
  }
  result.simulated_s = static_cast<double>(result.iterations) * dt_s;
  return result;
}

std::vector<Vec3d> face_samples(const GarmentPanel& panel, const std::vector<Vec3d>& position) {
  constexpr int per_side = 5;
  std::vector<Vec3d> samples;
  for (std::uint32_t row = 0; row + 1 < panel.rows; ++row)
    for (std::uint32_t column = 0; column + 1 < panel.columns; ++column) {
      const Vec3d &corner = position[panel.node(row, column)], &right = position[panel.node(row, column + 1)],
                  &up = position[panel.node(row + 1, column)],
                  &far = position[panel.node(row + 1, column + 1)];
      for (int i = 0; i < per_side; ++i)
        for (int j = 0; j < per_side; ++j) {
          const double u = i / (per_side - 1.0), v = j / (per_side - 1.0);
          samples.push_back(u + v <= 1 ? corner + u * (right - corner) + v * (up - corner)
                                       : far + (1 - u) * (up - far) + (1 - v) * (right - far));
        }
    }
  return samples;
}

Fit fit_of(const System& system, const std::vector<Vec3d>& position, const FitBody& body) {
  const auto& garment = std::get<Garment>(system.topology);
  Fit fit;
  fit.largest_gap = largest_gap(garment, position);
  for (const double depth : body.depths(position)) {
    fit.nodes_inside += depth > 0 ? 1U : 0U;
    fit.deepest_node = std::max(fit.deepest_node, depth);
  }
  for (const GarmentPanel& panel : garment.panels) {
    const std::vector<double> depths = body.depths(face_samples(panel, position));
    fit.deepest_face_sample = std::max(fit.deepest_face_sample, std::ranges::max(depths));
  }
  measure_side_distance(garment.close, position, body, fit);
  fit.upper_edge_rise = upper_edge_rise(garment, position);
  if (!garment.crotch.empty()) fit.crotch_rise = mean_rise(garment, position, garment.crotch);
  for (const std::vector<std::uint32_t>& loop : closed_rows(garment)) {
    Vec3d middle;
    for (const std::uint32_t node : loop) middle += 1 / static_cast<double>(loop.size()) * position[node];
    const bool goes_around = std::ranges::all_of(body.limb_axes(middle), [&](const Vec3d& axis) {
      return std::abs(turns_around(loop, position, axis)) == 1;
    });
    fit.rows = fit.rows.value_or(0) + 1;
    fit.rows_astray = fit.rows_astray.value_or(0) + (goes_around ? 0U : 1U);
  }
  const std::vector<double> longer = elongations(system, garment, position);
  fit.elongation_50 = quantile(longer, 0.5);
  fit.elongation_99 = quantile(longer, 0.99);
  fit.elongation_999 = quantile(longer, 0.999);
  fit.elongation_max = quantile(longer, 1);
  fit.crossings = count_crossings(garment, position);
  return fit;
}

std::vector<FitCheck> fit_checks(const Fit& fit, const FitBounds& bounds) {
  std::vector<FitCheck> checks;
  for (const FitNumber& number : numbers) {
    const std::optional<double> value = number.value(fit);
    if (!value) continue;
    const double per_unit = number.unit.per_unit;
    FitCheck& check = checks.emplace_back();
    check.name = number.name;
    check.value = per_unit * *value;
    if (number.bound == nullptr) continue;
    check.bound = shown_bound(number, bounds, per_unit);
    check.within = is_within(number, *value, bounds);
  }
  return checks;
}

std::vector<std::string> misfits(const DressingResult& result, const Fit& fit, const FitBounds& bounds) {
  std::vector<std::string> found;
  if (!result.seamed_at)
    found.emplace_back(
        "the seams did not close in time; try a larger seam_force_n_per_m or longest_seaming_s, or a wider "
        "garment");
  if (!result.settled)
    found.push_back(
        fmt::format("the garment did not come to rest within {:g} s; try a longer --duration of mssim run, "
                    "more viscous_damping_per_s or more nodes",
                    result.simulated_s));
  for (const FitNumber& number : numbers) {
    const std::optional<double> value = number.value(fit);
    if (number.bound == nullptr || !value || is_within(number, *value, bounds)) continue;
    const auto& [happened, remedy] = has_sign(number) && *value < 0 ? number.too_small : number.too_large;
    const Unit& unit = number.unit;
    found.push_back(fmt::format("{}: {} is {:g}{}, beyond {}{}; try {}", happened, number.what,
                                *value * unit.per_spoken, unit.spoken,
                                shown_bound(number, bounds, unit.per_spoken), unit.spoken, remedy));
  }
  return found;
}

}  // namespace mssim
