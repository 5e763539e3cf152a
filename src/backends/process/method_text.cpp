#include "backends/process/method_text.h"

#include <array>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string_view>

namespace mssim {
namespace {

constexpr std::array<std::string_view, slot_kinds> slot_names{
    "x", "v", "x_next", "v_next", "x_a", "v_a", "x_b", "v_b", "a", "temporary_1", "temporary_2"};

std::string_view name_of(Slot slot) { return slot_names.at(index(slot)); }

}  // namespace

std::string method_text(const Integrator& integrator) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  text << "integrator " << integrator.name << '\n';
  for (std::size_t s = 0; s < integrator.stage_count; ++s) {
    const Stage& stage = integrator.stages.at(s);
    text << "stage " << name_of(position_slot(stage.gather)) << ' ' << name_of(velocity_slot(stage.gather))
         << '\n';
    for (std::size_t i = 0; i < assignment_count(stage); ++i) {
      const Assignment& assignment = stage.assignments.at(i);
      text << "assign " << name_of(assignment.out);
      for (std::size_t t = 0; t < term_count(assignment); ++t) {
        const Term& term = assignment.terms.at(t);
        text << ' ' << term.coefficient << ' ' << term.dt_power << ' ' << name_of(term.slot);
      }
      text << '\n';
    }
  }
  return text.str();
}

}  // namespace mssim
