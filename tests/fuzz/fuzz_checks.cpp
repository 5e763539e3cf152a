#include "fuzz_checks.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

namespace mssim {
namespace {

bool is_utf8(std::string_view text) {
  try {
    // The strict writer refuses anything else.
    return !nlohmann::json(std::string(text)).dump().empty();
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

/// Of UTF-8: line feeds and the like, DEL, and U+0080 to U+009F.
bool has_control(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size(); ++i)
    if (byte(i) < 0x20 || byte(i) == 0x7F || (byte(i) == 0xC2 && byte(i + 1) < 0xA0)) return true;
  return false;
}

}  // namespace

std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

std::pair<std::string_view, std::string_view> two_texts(std::string_view input) {
  const std::size_t cut = std::min(input.find('\f'), input.size());
  return {input.substr(0, cut), input.substr(std::min(cut + 1, input.size()))};
}

void require(bool holds, std::string_view expected) {
  if (holds) return;
  std::fprintf(stderr, "expected: %.*s\n", static_cast<int>(expected.size()), expected.data());
  std::abort();
}

void require_sentence(std::string_view sentence) {
  constexpr std::size_t longest_sentence = 2000;
  const bool good =
      !sentence.empty() && sentence.size() <= longest_sentence && is_utf8(sentence) && !has_control(sentence);
  require(good, "one printable sentence, not \"" + std::string(sentence.substr(0, longest_sentence)) +
                    "\" of " + std::to_string(sentence.size()) + " bytes");
}

}  // namespace mssim
