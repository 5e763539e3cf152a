#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mssim {

/// `count` of `frames`, evenly spread from the first to the last; all where there are no more.
std::vector<std::size_t> spread_over(const std::vector<std::size_t>& frames, std::size_t count);

/// "WIDTHxHEIGHT" as two whole numbers from 1 to `most`; none where it is something else.
std::optional<std::pair<std::uint32_t, std::uint32_t>> two_numbers(std::string_view text, std::uint32_t most);

}  // namespace mssim
