#include "charts/svg_tags.h"

#include <algorithm>

namespace mssim {
namespace {

constexpr std::string_view spaces = " \t\n\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(spaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(spaces) - first + 1);
}

std::string with_single_spaces(std::string_view text) {
  std::string result;
  for (const char character : trimmed(text)) {
    const bool space = spaces.find(character) != std::string_view::npos;
    if (!space)
      result += character;
    else if (result.back() != ' ')
      result += ' ';
  }
  return result;
}

/// The attributes NAME = "VALUE" ..., all of them or none.
std::optional<std::vector<std::pair<std::string, std::string>>> attributes_of(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> attributes;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view name = trimmed(text.substr(0, equals));
    text = trimmed(text.substr(equals + 1));
    if (name.empty() || text.empty() || (text.front() != '"' && text.front() != '\'')) return std::nullopt;
    const std::size_t end = text.find(text.front(), 1);
    if (end == std::string_view::npos) return std::nullopt;
    attributes.emplace_back(name, with_single_spaces(text.substr(1, end - 1)));
    text.remove_prefix(end + 1);
  }
  return attributes;
}

}  // namespace

std::string* SvgTag::find(std::string_view attribute) {
  const auto found = std::ranges::find(attributes, attribute, [](const auto& one) { return one.first; });
  return found == attributes.end() ? nullptr : &found->second;
}

void SvgTag::remove(std::string_view attribute) {
  std::erase_if(attributes, [&](const auto& one) { return one.first == attribute; });
}

std::string SvgTag::written() const {
  if (!opens) return "</" + name + ">";
  std::string text = "<" + name;
  for (const auto& [attribute, value] : attributes) text += ' ' + attribute + "=\"" + value + '"';
  return text + (closes ? "/>" : ">");
}

std::optional<SvgPiece> take_piece(std::string_view& svg) {
  const std::size_t begin = svg.find('<');
  if (begin == std::string_view::npos) return std::nullopt;
  const std::size_t end = svg.find('>', begin);
  if (end == std::string_view::npos) return std::nullopt;
  SvgPiece piece{svg.substr(0, begin), {}};
  std::string_view inside = trimmed(svg.substr(begin + 1, end - begin - 1));
  svg.remove_prefix(end + 1);
  if (inside.starts_with('/')) {
    piece.tag.opens = false;
    inside.remove_prefix(1);
  } else if (inside.ends_with('/')) {
    inside.remove_suffix(1);
  } else {
    piece.tag.closes = false;
  }
  const std::size_t name_end = std::min(inside.find_first_of(spaces), inside.size());
  piece.tag.name = inside.substr(0, name_end);
  const auto attributes = attributes_of(inside.substr(name_end));
  if (!attributes || piece.tag.name.empty()) return std::nullopt;
  piece.tag.attributes = *attributes;
  return piece;
}

}  // namespace mssim
