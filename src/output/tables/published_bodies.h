#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "output/tables/table.h"

namespace mssim {

/// A body of Table 2 of Hong et al. (2016), as published.
struct PublishedBody {
  std::string object;  ///< box, sphere or torus
  std::string size;    ///< small, medium or large
  std::uint64_t nodes = 0;
  std::uint64_t springs = 0;  ///< as the paper counts them: three times the edges, by inference

  /// The name of its scene.
  std::string scene() const { return object + "-" + size; }
};

/// The bodies in the published order, from the data folder. Throws CsvError, and std::runtime_error when the
/// folder is missing.
std::vector<PublishedBody> published_bodies();

/// Takes the bodies from a table that was read. Throws CsvError.
std::vector<PublishedBody> published_bodies(const CsvTable& table);

}  // namespace mssim
