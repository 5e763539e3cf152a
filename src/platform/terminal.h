#pragma once

#include <optional>
#include <string_view>

namespace mssim {

/// What decides how an output stream is written; the texts are variables of the environment, empty where
/// unset.
struct StreamFacts {
  bool is_terminal = false;
  int columns = 0;  ///< as the terminal says; 0 where it does not
  std::string_view term = {}, no_color = {}, lc_all = {}, lc_ctype = {}, lang = {};
};

/// What may be written to an output stream.
struct Terminal {
  std::optional<int> width = {};  ///< columns; none where it is no terminal, and nothing has to fit
  bool rewrites = false;          ///< lines may be written over, by escape sequences
  bool colours = false;           ///< in addition to what characters say
  bool utf8 = false;              ///< characters beyond ASCII are shown
};

/// Colours need a terminal that knows escape sequences and no NO_COLOR (no-color.org).
Terminal terminal_with(const StreamFacts& facts);

/// The same for a descriptor, in this environment. The only place that asks what a stream leads to.
Terminal terminal_of(int descriptor);

}  // namespace mssim
