#include "backends/opencl/stencil.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "model/spring.h"

namespace mssim {
namespace {

/// Rows below and columns right of where a walk is.
using Place = std::pair<int, int>;

/// A spring of the stencil as a walk meets it: once, when it passes the row of its upper and the column of
/// its left end.
struct WalkedSpring {
  Place left, right;
  GridSpringKind kind;
};

constexpr int walk_reach = 2;  // rows and columns that grid_stage.cl has sums and shifts for
constexpr bool walk_reaches_all() {
  for (const GridSpring& spring : grid_stencil)
    if (spring.columns < 0 || std::max({spring.columns, spring.rows, -spring.rows}) > walk_reach)
      return false;
  return true;
}
static_assert(walk_reaches_all());

/// The stencil in the order in which a walk has the fewest nodes and forces in registers: of the springs that
/// are left, the next is one whose nodes are there already.
std::vector<WalkedSpring> springs_of_walk() {
  std::vector<WalkedSpring> waiting, ordered;
  for (const GridSpring& spring : grid_stencil) {
    const int left_row = std::max(0, -spring.rows);
    waiting.push_back({{left_row, 0}, {left_row + spring.rows, spring.columns}, spring.kind});
  }
  std::set<Place> loaded{{0, 0}};
  while (!waiting.empty()) {
    auto next = std::find_if(waiting.begin(), waiting.end(), [&](const WalkedSpring& spring) {
      return loaded.contains(spring.left) && loaded.contains(spring.right);
    });
    if (next == waiting.end()) next = waiting.begin();
    loaded.insert({next->left, next->right});
    ordered.push_back(*next);
    waiting.erase(next);
  }
  return ordered;
}

std::string text_of(const Place& place) {
  return std::to_string(place.first) + ", " + std::to_string(place.second);
}
/// Name of the nodes at a place, or of the forces on them.
std::string name_at(const char* what, const Place& place) {
  return std::string(what) + "_" + std::to_string(place.first) + "_" + std::to_string(place.second);
}

}  // namespace

std::string gather_springs_text() {
  std::ostringstream text;
  text << "static inline Vector gather_springs(__global const float* restrict pair, Site site, Node node,\n"
          "                                    __constant struct GridParameters* grid) {\n"
          "  Vector sum = no_vector(), on_other = no_vector();\n";
  for (const GridSpring& spring : grid_stencil)
    for (const int end : {1, -1}) {
      const std::string other = text_of({end * spring.rows, end * spring.columns});
      text << "  add_spring(&sum, &on_other, node, load_node(pair, site, " << other
           << ", grid), is_on_cloth(site, " << other << ", grid), " << spring.kind << ", grid);\n";
    }
  text << "  return sum;\n}\n";
  return text.str();
}

std::string walk_springs_text() {
  const std::vector<WalkedSpring> springs = springs_of_walk();
  std::map<Place, std::size_t> last_spring;  // of the springs with an end there
  for (std::size_t i = 0; i < springs.size(); ++i)
    last_spring[springs[i].left] = last_spring[springs[i].right] = i;

  std::ostringstream text;
  text << "typedef struct {\n";
  for (const auto& [place, last] : last_spring)
    if (place.second > 0) text << "  Vector " << name_at("on", place) << ";\n";
  text << "} Carry;\n"
          "static inline void clear_carry(Carry* carry) {\n";
  for (const auto& [place, last] : last_spring)
    if (place.second > 0) text << "  carry->" << name_at("on", place) << " = no_vector();\n";
  text << "}\n"
          "static inline Vector walk_springs(__global const float* restrict pair, Site site, Node node_0_0,\n"
          "                                  Carry* carry, __global float* restrict sums,\n"
          "                                  __constant struct GridParameters* grid) {\n";
  for (int row = 0; row <= walk_reach; ++row) {
    const std::string sums = "sums_" + std::to_string(row);
    text << "  __global float* " << sums << " = sums_of(sums, site.row + " << row
         << ", grid) + site.first_column;\n"
         << "  Vector " << name_at("on", {row, 0}) << " = "
         << (row < walk_reach ? "load_vector_aligned(" + sums + ", grid->stride)" : "no_vector()") << ";\n";
  }
  std::set<Place> loaded{{0, 0}};
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const auto& [left, right, kind] = springs[i];
    for (const Place& place : {left, right})
      if (loaded.insert(place).second) {
        text << "  const Node " << name_at("node", place) << " = load_node(pair, site, " << text_of(place)
             << ", grid);\n";
        if (place.second > 0) text << "  Vector " << name_at("on", place) << " = no_vector();\n";
      }
    const Place farthest{std::max(left.first, right.first), right.second};
    text << "  add_spring(&" << name_at("on", left) << ", &" << name_at("on", right) << ", "
         << name_at("node", left) << ", " << name_at("node", right) << ", is_on_cloth(site, "
         << text_of(farthest) << ", grid), " << kind << ", grid);\n";
    for (const auto& [place, last] : last_spring)
      if (last == i && place.second > 0) {
        const std::string on = name_at("on", place), total = name_at("on", {place.first, 0});
        text << "  " << total << " = plus(" << total << ", shifted_vector_" << place.second << "(carry->"
             << on << ", " << on << "));\n"
             << "  carry->" << on << " = " << on << ";\n";
      }
  }
  for (int row = 1; row <= walk_reach; ++row)
    text << "  store_vector_aligned(" << name_at("on", {row, 0}) << ", sums_" << row << ", grid->stride);\n";
  text << "  return on_0_0;\n}\n";
  return text.str();
}

}  // namespace mssim
