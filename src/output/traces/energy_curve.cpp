#include "output/traces/energy_curve.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

std::string ten_digits(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("energy curve: a number is not finite");
  return fmt::format("{:.10g}", value);
}

}  // namespace

EnergyCurve::EnergyCurve(std::filesystem::path file, std::string_view comment) : file_(std::move(file)) {
  std::string text;
  while (!comment.empty()) {
    const std::string_view line = take_to(comment, "\n");
    text += fmt::format("{}{}\n", line.empty() ? "#" : "# ", line);
  }
  file_.append(text + "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n");
}

void EnergyCurve::append(const EnergySample& sample) {
  if (samples_ > 0 && !(sample.time_s > last_time_s_))
    throw std::invalid_argument("energy curve: times must increase");
  const Energy& energy = sample.energy;
  std::string line = ten_digits(sample.time_s);
  for (const double value : {energy.kinetic, energy.elastic, energy.gravitational, energy.total()})
    line += ',' + ten_digits(value);
  file_.append(line + '\n');
  last_time_s_ = sample.time_s;
  ++samples_;
}

std::size_t EnergyCurve::give_up() {
  if (!file_.is_under_way()) return 0;
  if (samples_ > 0)
    file_.keep();
  else
    file_.remove();
  return samples_;
}

}  // namespace mssim
