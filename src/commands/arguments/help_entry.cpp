#include "commands/arguments/help_entry.h"

#include <sstream>

namespace mssim {

std::string help_entry(const std::string& name, const std::string& text) {
  constexpr std::size_t left_column = 26, page_width = 80;
  std::string page = "  " + name, line;
  // A name that fills its column has a line of its own.
  if (page.size() + 2 > left_column) page += '\n';
  const auto put = [&] {
    const std::size_t start = page.rfind('\n') + 1;
    page.append(left_column - (page.size() - start), ' ').append(line).append("\n");
    line.clear();
  };
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!line.empty() && left_column + line.size() + 1 + word.size() > page_width) put();
    line.append(line.empty() ? "" : " ").append(word);
  }
  put();
  return page;
}

}  // namespace mssim
