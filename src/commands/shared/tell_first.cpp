#include "commands/shared/tell_first.h"

#include <algorithm>
#include <cstddef>
#include <iostream>

#include "text/text.h"

namespace mssim {

void tell_first(const std::vector<std::string>& sentences) {
  constexpr std::size_t most = 3;
  const std::size_t told = sentences.size() == most + 1 ? most + 1 : std::min(sentences.size(), most);
  for (std::size_t i = 0; i < told; ++i) std::cerr << "mssim: " << escaped(sentences[i]) << '\n';
  if (told < sentences.size()) std::cerr << "mssim: and " << sentences.size() - told << " more\n";
}

}  // namespace mssim
