#include "backends/implicit/local_global/fronts.h"

#include <algorithm>

namespace mssim {

Fronts::Fronts(const StepMatrix& matrix, const Dissection& dissection) : parts(dissection.parts) {
  std::vector<std::uint32_t> place(matrix.rows()), part_of(matrix.rows());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[dissection.order[i]] = i;
  for (std::uint32_t part = 0; part < parts.size(); ++part)
    for (std::uint32_t i = parts[part].begin; i < parts[part].end; ++i) part_of[i] = part;
  std::vector<std::vector<std::uint32_t>> later(parts.size());
  for (const auto& coupling : matrix.couplings) {
    const auto [low, high] = std::minmax(place[coupling.first], place[coupling.second]);
    if (part_of[low] != part_of[high]) later[part_of[low]].push_back(high);
  }

  first_border.push_back(0);
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    std::vector<std::uint32_t>& mine = later[part];
    std::ranges::sort(mine);
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    border.insert(border.end(), mine.begin(), mine.end());
    first_border.push_back(border.size());
    if (parts[part].parent == Dissection::no_part) continue;
    std::vector<std::uint32_t>& inherited = later[parts[part].parent];
    inherited.insert(inherited.end(), std::ranges::lower_bound(mine, parts[parts[part].parent].end),
                     mine.end());
    mine = {};
  }

  at_parent.resize(border.size());
  first_child.resize(parts.size() + 1);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const std::uint32_t parent = parts[part].parent;
    if (parent == Dissection::no_part) continue;
    ++first_child[parent + 1];
    for (std::size_t i = first_border[part]; i < first_border[part + 1]; ++i)
      at_parent[i] = static_cast<std::uint32_t>(at(parent, border[i]));
  }
  for (std::size_t part = 0; part < parts.size(); ++part) first_child[part + 1] += first_child[part];
  children.resize(first_child.back());
  std::vector<std::uint32_t> next = first_child;
  for (std::uint32_t part = 0; part < parts.size(); ++part)
    if (parts[part].parent != Dissection::no_part) children[next[parts[part].parent]++] = part;
}

std::size_t Fronts::at(std::size_t part, std::uint32_t place) const {
  if (place < parts[part].end) return border_size(part) + (place - parts[part].begin);
  const auto begin = border.begin() + static_cast<std::ptrdiff_t>(first_border[part]);
  const auto end = border.begin() + static_cast<std::ptrdiff_t>(first_border[part + 1]);
  return static_cast<std::size_t>(std::lower_bound(begin, end, place) - begin);
}

}  // namespace mssim
