#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {

/// The candidate that `name` is most likely a misspelling of, or empty when none is near: at most a third of
/// its letters (and always up to one) inserted, deleted, replaced or swapped with a neighbour, capitals
/// counting as small letters.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);

/// A word that users type for a name that is spelt otherwise.
struct OtherName {
  std::string_view typed, meant;
};

/// " (did you mean A or B?)", or nothing: the name that `name` stands for in `others`, the nearest candidate,
/// or, where none is near, up to four candidates that begin with it, that it begins with (from four letters
/// on), or that have it between their hyphens.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates,
                         std::span<const OtherName> others = {});

/// "a, b and c", or with another last word "a, b or c".
std::string listed(std::span<const std::string_view> names, std::string_view last_word = "and");
std::string listed(const std::vector<std::string>& names, std::string_view last_word = "and");

/// The complaint about a name that is none of the known: "unknown WHAT "NAME" (did you mean NEAREST?): known
/// are A, B and C".
std::string unknown_name(std::string_view what, std::string_view name,
                         std::span<const std::string_view> known, std::span<const OtherName> others = {});

}  // namespace mssim
