#include "output/exports/obj_export.h"

#include <array>
#include <charconv>

#include "text/text.h"

namespace mssim {
namespace {

/// A blank and the shortest text that reads back as the same number.
void append_number(std::string& text, double value, bool in_double) {
  std::array<char, 32> digits{};
  char* const begin = digits.data();
  char* const end = begin + digits.size();
  text += ' ';
  text.append(begin, in_double ? std::to_chars(begin, end, value).ptr
                               : std::to_chars(begin, end, static_cast<float>(value)).ptr);
}

}  // namespace

std::string obj_of(const ExportMesh& mesh, const ExportFrame& frame) {
  std::string text = "# mssim, time " + decimal(frame.time_s) + " s, lengths in m\n";
  for (const Vec3d& point : frame.position) {
    text += 'v';
    for (const double number : {point.x, point.y, point.z}) append_number(text, number, mesh.in_double);
    text += '\n';
  }
  const std::array<std::uint32_t, 3>* before = nullptr;
  for (const auto& triangle : mesh.triangles) {
    const std::int32_t part = mesh.part[triangle[0]];
    if (!before || part != mesh.part[(*before)[0]])
      text += "o " + (part < 0 ? "person" : printable(mesh.parts[static_cast<std::size_t>(part)])) + '\n';
    before = &triangle;
    text += 'f';
    for (const std::uint32_t point : triangle) text += ' ' + std::to_string(point + std::uint64_t{1});
    text += '\n';
  }
  return text;
}

}  // namespace mssim
