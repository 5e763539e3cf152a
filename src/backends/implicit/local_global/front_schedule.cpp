#include "backends/implicit/local_global/front_schedule.h"

#include <algorithm>
#include <cstdint>

namespace mssim {
namespace {

/// Subtrees for each thread, so that what they cost can be shared evenly.
constexpr std::size_t subtrees_per_thread = 8;

}  // namespace

FrontSchedule::FrontSchedule(const BlockFactor& factor, std::size_t threads) {
  const auto& parts = factor.fronts.parts;
  const std::size_t count = parts.size();
  // Of the subtree below each part, which is the parts from `first` to itself.
  std::vector<std::size_t> cost(count), first(count);
  std::size_t all = 0;
  for (std::size_t part = 0; part < count; ++part) {
    const auto children = factor.fronts.children_of(part);
    cost[part] += factor.cost(part);
    first[part] = children.empty() ? part : first[children.front()];
    all += factor.cost(part);
    if (parts[part].parent != Dissection::no_part) cost[parts[part].parent] += cost[part];
  }
  // One thread meets nobody: it takes all at once.
  const std::size_t most = threads == 1 ? all : all / (threads * subtrees_per_thread);

  std::vector<std::size_t> phase(count);  // 0: within a subtree that is one item
  std::vector<std::vector<Item>> items(1);
  for (std::size_t part = 0; part < count; ++part) {
    const bool is_top = parts[part].parent == Dissection::no_part || cost[parts[part].parent] > most;
    if (cost[part] <= most) {
      if (is_top) items[0].push_back({first[part], part + 1});
      continue;
    }
    for (const std::uint32_t child : factor.fronts.children_of(part))
      phase[part] = std::max(phase[part], phase[child]);
    ++phase[part];
    if (phase[part] == items.size()) items.emplace_back();
    items[phase[part]].push_back({part, part + 1});
  }
  for (std::vector<Item>& of_phase : items) {
    const auto item_cost = [&](const Item& item) {
      return item.end - item.begin == 1 ? factor.cost(item.begin) : cost[item.end - 1];
    };
    // The dearest first, each to who has least: then in order again.
    std::ranges::stable_sort(of_phase, std::ranges::greater{}, item_cost);
    std::vector<std::vector<Item>> shares(threads);
    std::vector<std::size_t> load(threads);
    for (const Item& item : of_phase) {
      const auto thread = static_cast<std::size_t>(std::ranges::min_element(load) - load.begin());
      shares[thread].push_back(item);
      load[thread] += item_cost(item);
    }
    for (std::vector<Item>& share : shares) std::ranges::sort(share, {}, &Item::begin);
    phases.push_back(std::move(shares));
  }
}

}  // namespace mssim
