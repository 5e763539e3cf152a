#include "output/pictures/painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "output/traces/trace_content.h"
#include "picture/colour_bar.h"
#include "picture/colour_map.h"
#include "picture/legend.h"
#include "render/srgb.h"
#include "scene/fields/fields.h"

namespace mssim {
namespace {

constexpr Rgb skin_tone{201, 188, 178}, denim{58, 88, 140};

/// Colour of the side that is turned away: paler.
Light inside_of(const Light& colour) {
  constexpr float kept = 0.72F;
  return kept * colour + (1 - kept) * Light{0.55F, 0.55F, 0.55F};
}

/// The colour of each part of a skin.
std::vector<Rgb> part_colours(const Topology& topology, const Skin& skin, ColourBy colour) {
  const auto* garment = std::get_if<Garment>(&topology);
  const auto& categories = category_colours();
  std::vector<Rgb> colours;
  for (std::size_t part = 0; part < skin.parts.size(); ++part) {
    const std::size_t object = garment && colour != ColourBy::panel ? garment->panels[part].layer : part;
    // A single object has a colour that suits it; several are told apart.
    colours.push_back(object == 0 && (skin.parts.size() == 1 || (garment && colour != ColourBy::panel))
                          ? denim
                          : categories[object % categories.size()]);
  }
  return colours;
}

/// What all but the most strained fiftieth of the nodes stay below, in either direction.
double usual_most(std::vector<double> strain) {
  for (double& value : strain) value = std::abs(value);
  const auto place = strain.begin() + static_cast<std::ptrdiff_t>(strain.size() * 49 / 50);
  std::ranges::nth_element(strain, place);
  return *place;
}

}  // namespace

Painter::Painter(const TraceContent& content, const std::vector<Vec3d>& start, const PictureOptions& options)
    : content_(content),
      options_(options),
      camera_(options.view),
      skin_(skin_of(content.topology, start)),
      colour_(part_colours(content.topology, skin_, options.colour)),
      floor_(stated_floor(content.scene_json)) {}

std::vector<Vec3d> Painter::points_at(const std::vector<Vec3d>& positions) const {
  std::vector<Vec3d> points;
  points.reserve(skin_.node.size() + content_.body.points.size());
  for (const std::uint32_t node : skin_.node) points.push_back(positions[node]);
  points.insert(points.end(), content_.body.points.begin(), content_.body.points.end());
  return points;
}

void Painter::make_room_for(const std::vector<Vec3d>& positions) {
  const std::vector<Vec3d> points = points_at(positions);
  const Box<double> seen = seen_box(camera_, points);
  seen_ = seen_ ? united(*seen_, seen) : seen;
  if (!world_) world_ = {points.front(), points.front()};
  for (const Vec3d& point : points) extend(*world_, point);
  if (options_.colour == ColourBy::strain)
    most_strain_ = std::max(most_strain_, usual_most(node_strain(content_, positions)));
}

void Painter::write_legend(Picture& picture) const {
  constexpr double percent = 100;
  if (options_.colour == ColourBy::strain) {
    draw_colour_bar(picture,
                    {diverging_map(), -percent * most_strain_, percent * most_strain_, "strain in %", true},
                    Corner::top_right);
    return;
  }
  std::vector<LegendEntry> entries;
  for (std::size_t part = 0; part < skin_.parts.size(); ++part)
    entries.push_back({colour_[part], skin_.parts[part]});
  if (options_.colour == ColourBy::panel && entries.size() > 1)
    draw_legend(picture, entries, Corner::top_right);
}

Shot Painter::shot() const {
  // A little below what lies on the ground, so that the two do not show through each other.
  constexpr double gap = 0.003, far = 1.0;  // of the height, or of the width where that is more
  const Vec3d size = world_->size();
  const double extent = std::max({size.x, size.y, size.z});
  const bool near_floor = floor_ && *floor_ <= world_->low.y && world_->low.y - *floor_ < far * extent;
  const double ground = (near_floor ? *floor_ : world_->low.y) - gap * extent;
  return {options_.view, options_.width, options_.height, *seen_, Ground(*world_, ground), options_.threads};
}

Picture Painter::picture_of(const std::vector<Vec3d>& positions) const {
  Subject subject{{points_at(positions), skin_.triangles}, {}, {}};
  subject.front.reserve(subject.surface.points.size());
  if (options_.colour == ColourBy::strain) {
    const std::vector<double> strain = node_strain(content_, positions);
    for (const std::uint32_t node : skin_.node)
      subject.front.push_back(light_of(diverging_map().at(0.5 + 0.5 * strain[node] / most_strain_)));
    subject.back = subject.front;
  } else {
    std::vector<Light> colour;  // by part: a skin has many more points
    for (const Rgb& code : colour_) colour.push_back(light_of(code));
    for (const std::uint32_t part : skin_.part) {
      subject.front.push_back(colour[part]);
      subject.back.push_back(inside_of(colour[part]));
    }
  }
  const auto first = static_cast<std::uint32_t>(skin_.node.size());
  for (const auto& [a, b, c] : content_.body.triangles)
    subject.surface.triangles.push_back({first + a, first + b, first + c});
  subject.front.resize(subject.surface.points.size(), light_of(skin_tone));
  subject.back.resize(subject.surface.points.size(), light_of(skin_tone));
  Picture picture = drawn(subject, shot());
  write_legend(picture);
  return picture;
}

}  // namespace mssim
