#include "text/shell_word.h"

namespace mssim {

std::string shell_word(const std::string& text) {
  const bool plain = !text.empty() && text.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyz"
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-+=:,./~%@") == std::string::npos;
  if (plain) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'')
      word += "'\\'";  // closes the quotes, a quoted quote, and the next character opens them again
    word += c;
  }
  word += '\'';
  return word;
}

}  // namespace mssim
