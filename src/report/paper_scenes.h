#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/result.h"
#include "output/tables/paper_table.h"
#include "output/tables/published.h"

namespace mssim {

/// A scene of a published table that was measured.
struct PaperScene {
  std::string name;
  std::uint64_t nodes = 0;
  std::optional<std::uint64_t> springs_published;
};

/// A published table and the rows that were measured of its scenes: what verdicts and charts ask of both.
class PaperScenes {
 public:
  /// All must outlive it.
  PaperScenes(std::span<const ResultRow> rows, const PaperLegend& legend, const PublishedTable& published);

  const std::vector<PaperScene>& scenes() const { return scenes_; }  ///< by size
  const PaperLegend& legend() const { return legend_; }
  const PublishedTable& published() const { return published_; }
  /// "Table 1", for sentences.
  std::string label() const;

  std::optional<double> published_ms(const PaperScene& scene, std::string_view integrator,
                                     std::string_view configuration) const;
  /// Over one thread; none where either time is missing.
  std::optional<double> published_speedup(const PaperScene& scene, std::string_view integrator,
                                          std::string_view configuration) const;
  bool has_configuration(std::string_view configuration) const;
  /// Null where there is none.
  const ResultRow* row(const PaperScene& scene, std::string_view backend, std::string_view integrator) const;
  /// Has any scene a time of it?
  bool has(std::string_view backend, std::string_view integrator) const;
  /// The backends that stand for a configuration and have a time.
  std::vector<std::string> backends_of(std::string_view configuration) const;

 private:
  std::span<const ResultRow> rows_;
  const PaperLegend& legend_;
  const PublishedTable& published_;
  std::vector<PaperScene> scenes_;
};

/// The configuration that speed-ups are over.
inline constexpr std::string_view one_thread_configuration = "cpu-only";

/// "Multi-thread CPU" of "multi-thread-cpu".
std::string_view caption_of(std::string_view configuration);

}  // namespace mssim
