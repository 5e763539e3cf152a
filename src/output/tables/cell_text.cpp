#include "output/tables/cell_text.h"

#include <cstdint>
#include <string_view>

#include "text/text.h"

namespace mssim {
namespace {

/// A cell's value as people read it.
struct Shown {
  const Cell& cell;
  const std::string& unit;

  std::string operator()(std::monostate) const { return "–"; }
  std::string operator()(bool truth) const { return truth ? "yes" : "no"; }
  std::string operator()(std::int64_t number) const {
    return grouped(static_cast<std::uint64_t>(number)) + unit;
  }
  std::string operator()(double number) const {
    return (cell.exact ? decimal(number) : three_digits(number)) + unit;
  }
  std::string operator()(const std::string& text) const { return text; }
};

}  // namespace

std::string cell_text(const Cell& cell, const Column& column) {
  const std::string_view around = cell.strong ? "**" : "";
  std::string text(around);
  return text.append(std::visit(Shown{cell, column.unit}, cell.value)).append(around).append(cell.suffix);
}

}  // namespace mssim
