#include "commands/bench/bench_verdict.h"

#include <algorithm>

namespace mssim {
namespace {

bool is_wrong(const ResultRow& row) {
  return row.status.starts_with("failed") || (row.status == "ok" && !row.verified);
}

/// Whether `member` of the row is one of `names`, and no row of the scene that has the same could run: a
/// backend that has a garment with one of the integrators has it.
bool is_missed(const ResultRow& row, const std::vector<std::string>& names, std::string ResultRow::*member,
               const std::vector<ResultRow>& rows) {
  return std::ranges::find(names, row.*member) != names.end() &&
         std::ranges::none_of(rows, [&](const ResultRow& other) {
           return other.scene == row.scene && other.*member == row.*member && other.verified;
         });
}

template <class IsBad>
std::vector<std::string> reasons(const std::vector<ResultRow>& rows, IsBad is_bad) {
  std::vector<std::string> sentences;
  for (const ResultRow& row : rows)
    if (is_bad(row)) sentences.push_back(combination_name(row) + ": " + status_of(row));
  return sentences;
}

}  // namespace

BenchVerdict verdict_of(const std::vector<ResultRow>& rows, const std::vector<std::string>& asked_backends,
                        const std::vector<std::string>& asked_integrators) {
  BenchVerdict verdict{exit_not_verified, reasons(rows, is_wrong)};
  if (!verdict.reasons.empty()) return verdict;
  verdict = {exit_unavailable, reasons(rows, [&](const ResultRow& row) {
               return is_missed(row, asked_backends, &ResultRow::backend, rows) ||
                      is_missed(row, asked_integrators, &ResultRow::integrator, rows);
             })};
  if (verdict.reasons.empty()) verdict.exit_code = exit_ok;
  return verdict;
}

}  // namespace mssim
