#include "backends/layouts/alike_springs.h"

#include <limits>
#include <numeric>
#include <string>

#include "backends/interface/backend.h"

namespace mssim {

AlikeSprings::AlikeSprings(const std::vector<AlikeBodies>& bodies) : slices(bodies, slice_nodes) {
  for (const AlikeBodies& of : bodies) shapes.push_back({of.stiffness, of.damping});
  std::size_t count = 0;
  for (const AlikeSlices::Group& group : slices.groups) count += bodies[group.shape].springs.size();
  constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max() / slice_nodes;
  if (count > largest)
    throw Unsupported("the scene has " + std::to_string(count) +
                      " springs for each lane; hybrid supports at most " + std::to_string(largest));
  springs.reserve(count);
  std::vector<std::uint32_t> ends(slices.count, 0);
  for (const AlikeSlices::Group& group : slices.groups) {
    const AlikeBodies& of = bodies[group.shape];
    const auto slice = static_cast<std::uint32_t>(group.first_slice);
    pinned.insert(pinned.end(), of.pinned.begin(), of.pinned.end());
    for (std::uint32_t node = 0; node < of.nodes(); ++node) {
      first_end.push_back(static_cast<std::uint32_t>(springs.size()));
      for (std::uint32_t s = of.first_spring[node]; s < of.first_spring[node + 1]; ++s) {
        const AlikeBodies::SpringAhead& spring = of.springs[s];
        springs.push_back({slice + node, slice + spring.other, spring.stiffness_rest,
                           static_cast<std::uint32_t>(group.shape)});
        ++ends[slice + spring.other];
      }
    }
  }
  first_end.push_back(static_cast<std::uint32_t>(springs.size()));

  first_subtracted.assign(slices.count + 1, 0);
  std::partial_sum(ends.begin(), ends.end(), first_subtracted.begin() + 1);
  std::vector<std::uint32_t> next(first_subtracted.begin(), first_subtracted.end() - 1);
  subtracted.resize(springs.size());
  for (std::uint32_t s = 0; s < springs.size(); ++s) subtracted[next[springs[s].second]++] = s;
}

}  // namespace mssim
