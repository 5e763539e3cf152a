#pragma once

#include <string>
#include <string_view>

namespace mssim {

/// Adds a sentence to a note, which reads "one; another". An empty sentence changes nothing.
inline void add_to_note(std::string& note, std::string_view sentence) {
  if (!note.empty() && !sentence.empty()) note += "; ";
  note += sentence;
}

}  // namespace mssim
