#include "output/energy_curve.h"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

#include "output/atomic_file.h"

namespace mssim {
namespace {

/// to_chars, unlike streams and printf, knows no locale.
void append_number(std::string& text, double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("energy curve: a number is not finite");
  constexpr int significant_digits = 10;
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, significant_digits)
                       .ptr;
  text.append(buffer.data(), end);
}

void append_comment(std::string& text, std::string_view comment) {
  while (!comment.empty()) {
    const std::size_t length = comment.find('\n');
    const std::string_view line = comment.substr(0, length);
    text += line.empty() ? "#" : "# ";
    text += line;
    text += '\n';
    comment.remove_prefix(length == std::string_view::npos ? comment.size() : length + 1);
  }
}

}  // namespace

void write_energy_curve(const std::filesystem::path& file, std::span<const EnergySample> samples,
                        std::string_view comment) {
  std::string text;
  append_comment(text, comment);
  text += "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n";
  const EnergySample* previous = nullptr;
  for (const EnergySample& sample : samples) {
    if (previous && !(sample.time_s > previous->time_s))
      throw std::invalid_argument("energy curve: times must increase");
    previous = &sample;
    append_number(text, sample.time_s);
    for (const double energy :
         {sample.energy.kinetic, sample.energy.elastic, sample.energy.gravitational, sample.energy.total()}) {
      text += ',';
      append_number(text, energy);
    }
    text += '\n';
  }
  write_file_atomically(file, text);
}

}  // namespace mssim
