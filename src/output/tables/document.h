#pragma once

#include <string>
#include <variant>
#include <vector>

#include "output/tables/table.h"

namespace mssim {

/// A page for people, as blocks one below the other. Text may have `code`, *emphasis* and **strong** as
/// Markdown has them.

struct Heading {
  int level = 1;
  std::string text;
};
struct Paragraph {
  std::string text;
};
struct BulletList {
  std::vector<std::string> items;
};
using Document = std::vector<std::variant<Heading, Paragraph, BulletList, Table>>;

/// Adds a paragraph with this sentence, which lacks its full stop; nothing for an empty one.
inline void add_sentence(Document& page, const std::string& sentence) {
  if (!sentence.empty()) page.emplace_back(Paragraph{sentence + '.'});
}

}  // namespace mssim
