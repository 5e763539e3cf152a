#include "platform/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>

namespace mssim {
namespace {

std::string_view variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? std::string_view() : value;
}

/// As the C library looks a locale up: the first of the three that is not empty.
bool is_utf8(const StreamFacts& facts) {
  const std::string_view locale = !facts.lc_all.empty()     ? facts.lc_all
                                  : !facts.lc_ctype.empty() ? facts.lc_ctype
                                                            : facts.lang;
  for (const std::string_view name : {"UTF-8", "utf-8", "UTF8", "utf8"})
    if (locale.find(name) != std::string_view::npos) return true;
  return false;
}

}  // namespace

Terminal terminal_with(const StreamFacts& facts) {
  constexpr int usual_width = 80;
  Terminal terminal;
  terminal.utf8 = is_utf8(facts);
  if (!facts.is_terminal) return terminal;
  terminal.width = facts.columns > 0 ? facts.columns : usual_width;
  terminal.rewrites = !facts.term.empty() && facts.term != "dumb";
  terminal.colours = terminal.rewrites && facts.no_color.empty();
  return terminal;
}

Terminal terminal_of(int descriptor) {
  StreamFacts facts{.term = variable("TERM"),
                    .no_color = variable("NO_COLOR"),
                    .lc_all = variable("LC_ALL"),
                    .lc_ctype = variable("LC_CTYPE"),
                    .lang = variable("LANG")};
  facts.is_terminal = isatty(descriptor) != 0;
  winsize size{};
  if (facts.is_terminal && ioctl(descriptor, TIOCGWINSZ, &size) == 0) facts.columns = size.ws_col;
  return terminal_with(facts);
}

}  // namespace mssim
