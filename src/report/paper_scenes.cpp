#include "report/paper_scenes.h"

#include <algorithm>

namespace mssim {

PaperScenes::PaperScenes(std::span<const ResultRow> rows, const PaperLegend& legend,
                         const PublishedTable& published)
    : rows_(rows), legend_(legend), published_(published) {
  for (const ResultRow& row : rows)
    if (published.has_scene(row.nodes, row.springs_published) &&
        std::ranges::find(scenes_, row.scene, &PaperScene::name) == scenes_.end())
      scenes_.push_back({row.scene, row.nodes, row.springs_published});
  std::ranges::stable_sort(scenes_, {}, &PaperScene::nodes);
}

std::string PaperScenes::label() const {
  // The title says what is measured, the table, and whose it is: "Cloth: Table 1 of Hong et al. (2016)".
  const std::string_view title = published_.info().title;
  const std::size_t colon = title.find(": "), from = colon == std::string_view::npos ? 0 : colon + 2;
  return std::string(title.substr(from, title.find(" of ", from) - from));
}

std::optional<double> PaperScenes::published_ms(const PaperScene& scene, std::string_view integrator,
                                                std::string_view configuration) const {
  return published_.ms(integrator, configuration, scene.nodes, scene.springs_published);
}

std::optional<double> PaperScenes::published_speedup(const PaperScene& scene, std::string_view integrator,
                                                     std::string_view configuration) const {
  const auto ms = published_ms(scene, integrator, configuration);
  const auto base = published_ms(scene, integrator, one_thread_configuration);
  return ms && base ? std::optional(*base / *ms) : std::nullopt;
}

bool PaperScenes::has_configuration(std::string_view configuration) const {
  return std::ranges::any_of(scenes_, [&](const PaperScene& scene) {
    return std::ranges::any_of(legend_.integrators, [&](const PaperLegend::Integrator& integrator) {
      return published_ms(scene, integrator.paper_name, configuration).has_value();
    });
  });
}

const ResultRow* PaperScenes::row(const PaperScene& scene, std::string_view backend,
                                  std::string_view integrator) const {
  const auto found = std::ranges::find_if(rows_, [&](const ResultRow& row) {
    return row.scene == scene.name && row.backend == backend && row.integrator == integrator;
  });
  return found == rows_.end() ? nullptr : &*found;
}

bool PaperScenes::has(std::string_view backend, std::string_view integrator) const {
  return std::ranges::any_of(scenes_, [&](const PaperScene& scene) {
    const ResultRow* found = row(scene, backend, integrator);
    return found && counts(*found);
  });
}

std::vector<std::string> PaperScenes::backends_of(std::string_view configuration) const {
  std::vector<std::string> names;
  for (const PaperLegend::Backend& backend : legend_.backends)
    if (backend.configuration == configuration &&
        std::ranges::any_of(legend_.integrators, [&](const PaperLegend::Integrator& integrator) {
          return has(backend.name, integrator.name);
        }))
      names.push_back(backend.name);
  return names;
}

std::string_view caption_of(std::string_view configuration) {
  const auto found = std::ranges::find(paper_configurations, configuration, &PaperConfiguration::name);
  return found == paper_configurations.end() ? configuration : found->caption;
}

}  // namespace mssim
