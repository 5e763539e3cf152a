#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace mssim {

/// The text as a number, in every locale and with or without a sign; none where it is anything else, has
/// anything beside the number, or does not fit.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

}  // namespace mssim
