// What was measured or published: timings.csv, form feed, samples.csv or garment.csv; or a published table
// alone.

#include <string>
#include <vector>

#include "fuzz_checks.h"
#include "garment/output/garment_tables.h"
#include "output/tables/results.h"
#include "output/tables/suite_tables.h"
#include "output/tables/table.h"

namespace mssim {
namespace {

std::vector<std::string> record_of(const CsvTable& table, std::size_t record) {
  std::vector<std::string> fields;
  for (std::size_t column = 0; column < table.header().size(); ++column)
    fields.push_back(table.text(record, column));
  return fields;
}

void check_table(const CsvTable& table) {
  if (table.header().empty()) {
    require(table.size() == 0, "a table without a header is empty");
    return;
  }
  std::string text = csv_line(table.header());
  for (std::size_t r = 0; r < table.size(); ++r) text += csv_line(record_of(table, r));
  const CsvTable again("again.csv", text);
  require(again.header() == table.header() && again.size() == table.size(), "a written table reads back");
  for (std::size_t r = 0; r < table.size(); ++r)
    require(record_of(again, r) == record_of(table, r), "a written record reads back");
}

void check_timings(const CsvTable& timings, std::string_view samples_text) {
  const auto rows = unless_refused<CsvError>([&] { return read_timings(timings); });
  if (!rows) return;
  require(rows->size() == timings.size(), "a record is a row");
  // The writer throws for what is not finite, too.
  const std::string written = timings_csv(*rows);
  require(timings_csv(read_timings(CsvTable("again.csv", written))) == written, "written timings read back");

  // The second part may as well be a garment.csv.
  unless_refused<CsvError>([&] {
    std::vector<ResultRow> result = *rows;
    const CsvTable dressings("garment.csv", samples_text);
    read_dressings(dressings, result);
    return result;
  });

  const auto with_samples = unless_refused<CsvError>([&] {
    std::vector<ResultRow> result = *rows;
    read_samples(CsvTable("samples.csv", samples_text), result);
    return result;
  });
  if (!with_samples) return;
  const std::string samples = samples_csv(*with_samples);
  std::vector<ResultRow> again = *rows;
  read_samples(CsvTable("again.csv", samples), again);
  for (std::size_t row = 0; row < again.size(); ++row)
    require(again[row].samples_ms == (*with_samples)[row].samples_ms &&
                again[row].sample_steps == (*with_samples)[row].sample_steps,
            "written samples read back");
}

void check_published(const CsvTable& table) {
  for (const PublishedTableInfo& info : published_table_kinds)
    unless_refused<CsvError>([&] { return PublishedTable(info, table); });
  const auto bodies = unless_refused<CsvError>([&] { return published_bodies(table); });
  if (bodies) require(bodies->size() == table.size(), "a record is a body");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto [first, second] = two_texts(text_of(data, size));
  const auto table = unless_refused<CsvError>([text = first] { return CsvTable("fuzz.csv", text); });
  if (!table) return 0;
  check_table(*table);
  check_timings(*table, second);
  check_published(*table);
  return 0;
}

}  // namespace mssim
