#include "output/tables/ratio_mark.h"

#include <algorithm>
#include <charconv>

#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view mark = "†";

/// As a reader sees it.
double rounded(double value) {
  const std::string text = three_digits(value);
  double read = value;
  std::from_chars(text.data(), text.data() + text.size(), read);
  return read;
}

bool has_mark(const Table& table) {
  return std::ranges::any_of(table.rows, [](const std::vector<Cell>& row) {
    return std::ranges::any_of(row,
                               [](const Cell& cell) { return cell.suffix.find(mark) != std::string::npos; });
  });
}

std::string legend(bool wanted) {
  if (!wanted) return {};
  return std::string(mark) +
         " the two times shown contradict this ratio: their quotient differs from it by more than a quarter, "
         "or names the other one as the faster; trust the ratio, which compares single samples instead of "
         "medians";
}

}  // namespace

std::string_view mark_of_ratio(double ratio, double time, double other) {
  constexpr double largest_difference = 1.25;
  const double shown = rounded(ratio), quotient = rounded(time) / rounded(other);
  const bool differs = std::max(shown / quotient, quotient / shown) > largest_difference;
  return differs || (shown - 1) * (quotient - 1) < 0 ? mark : "";
}

std::string legend_of_ratios(const Table& table) { return legend(has_mark(table)); }

std::string legend_of_ratios(std::string_view table) {
  return legend(table.find(mark) != std::string_view::npos);
}

std::string legend_of_ratios(const Document& page) {
  return legend(std::ranges::any_of(page, [](const auto& block) {
    const auto* table = std::get_if<Table>(&block);
    return table != nullptr && has_mark(*table);
  }));
}

}  // namespace mssim
