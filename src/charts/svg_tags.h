#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mssim {

/// A tag of XML, such as <path d="M0,0"/>.
struct SvgTag {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< values as written, with single spaces
  bool opens = true;                                            ///< false of </g>
  bool closes = true;                                           ///< false of <g>; true of <path/> and </g>

  /// The value of an attribute; null where it has none.
  std::string* find(std::string_view attribute);
  void remove(std::string_view attribute);
  std::string written() const;
};

/// A tag with the text before it.
struct SvgPiece {
  std::string_view text;
  SvgTag tag;
};

/// Takes the next piece off the front of `svg`; none where no tag follows, or one that is not well formed.
/// Declarations (<?xml ...?>) and comments are no tags.
std::optional<SvgPiece> take_piece(std::string_view& svg);

}  // namespace mssim
