#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace mssim {

/// What a fuzz target is: is called with one input after the other, and must come back from each of them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// The bytes of an input as text.
std::string_view text_of(const std::uint8_t* data, std::size_t size);

/// An input for a reader of two files: what stands before the first form feed, and what stands behind it.
std::pair<std::string_view, std::string_view> two_texts(std::string_view input);

/// Prints what was expected and ends the process, unless it holds: the fuzzer then keeps the input.
void require(bool holds, std::string_view expected);

/// Requires of an error's text what a user may expect: one line, not empty, valid UTF-8 without control
/// characters, and at most 2,000 bytes, whatever the input.
void require_sentence(std::string_view sentence);

/// What `read` returns, or nothing when it refuses the input by an Error, whose sentence is checked. Any
/// other exception ends the process.
template <class Error, class Read>
auto unless_refused(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    require_sentence(error.what());
    return std::nullopt;
  }
}

}  // namespace mssim
