#include "output/traces/trace_name.h"

#include <string_view>

#include "text/text.h"

namespace mssim {

std::optional<std::string> trace_name_problem(const std::filesystem::path& trace) {
  constexpr std::string_view misread = ":|\\";
  const std::string name = trace.filename().string();
  const std::string shown = '"' + printable(name) + '"';
  if (trace.extension() != ".h5")
    return shown + " is not a name of the form NAME.h5: give " +
           (name.empty() ? "a file in that folder" : printable(trace.stem().string()) + ".h5");
  if (const std::size_t at = name.find_first_of(misread); at != std::string::npos)
    return shown + " has a '" + name[at] +
           "', which readers of the XDMF file misread: give a name without it";
  if (escaped(name) != name)
    return shown +
           " has characters that are not printable, which an XDMF file cannot hold: give a name without them";
  if (name.front() == ' ' || trace.stem().string().back() == ' ')
    return shown +
           " begins or ends with a blank, which readers of the XDMF file drop: give a name without it";
  return std::nullopt;
}

}  // namespace mssim
