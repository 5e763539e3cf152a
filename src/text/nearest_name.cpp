#include "text/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "text/printable.h"

namespace mssim {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Optimal string alignment distance: Levenshtein's, and a swap of neighbours counts as one edit.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = lower(a[i - 1]), y = lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (x == y ? 0 : 1)});
      if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y)
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

/// Whether a user who knows half of `candidate` may have typed `name`.
bool are_akin(std::string_view name, std::string_view candidate) {
  constexpr std::size_t telling_length = 4;
  return candidate.starts_with(name) || (candidate.size() >= telling_length && name.starts_with(candidate)) ||
         ('-' + std::string(candidate) + '-').find('-' + std::string(name) + '-') != std::string::npos;
}

std::vector<std::string_view> likely_names(std::string_view name,
                                           std::span<const std::string_view> candidates,
                                           std::span<const OtherName> others) {
  constexpr std::size_t most = 4;
  for (const OtherName& other : others)
    if (edit_distance(name, other.typed) == 0) return {other.meant};
  if (const std::string_view nearest = nearest_name(name, candidates); !nearest.empty()) return {nearest};
  std::vector<std::string_view> akin;
  for (const std::string_view candidate : candidates)
    if (are_akin(name, candidate)) akin.push_back(candidate);
  return name.empty() || akin.size() > most ? std::vector<std::string_view>() : akin;
}

}  // namespace

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  std::string_view nearest;
  std::size_t nearest_distance = 0;
  for (const std::string_view candidate : candidates) {
    const std::size_t allowed = std::max<std::size_t>(1, candidate.size() / 3);
    // Also keeps a name of megabytes from costing a table of megabytes.
    if (name.size() > candidate.size() + allowed) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance > allowed || (!nearest.empty() && distance >= nearest_distance)) continue;
    nearest = candidate;
    nearest_distance = distance;
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates,
                         std::span<const OtherName> others) {
  const std::vector<std::string_view> likely = likely_names(name, candidates, others);
  return likely.empty() ? "" : " (did you mean " + listed(likely, "or") + "?)";
}

std::string listed(std::span<const std::string_view> names, std::string_view last_word) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0 && i + 1 < names.size()) list += ", ";
    if (i > 0 && i + 1 == names.size()) list.append(" ").append(last_word).append(" ");
    list += names[i];
  }
  return list;
}

std::string listed(const std::vector<std::string>& names, std::string_view last_word) {
  return listed(std::vector<std::string_view>(names.begin(), names.end()), last_word);
}

std::string unknown_name(std::string_view what, std::string_view name,
                         std::span<const std::string_view> known, std::span<const OtherName> others) {
  return "unknown " + std::string(what) + " \"" + printable(name) + '"' + did_you_mean(name, known, others) +
         ": known are " + listed(known);
}

}  // namespace mssim
