#include "output/pictures/painter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/geometry.h"
#include "picture/legend.h"
#include "scene/fields/fields.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Vec3d normal_of(const Triangle& triangle, const std::vector<Vec3d>& points) {
  const Vec3d& a = points[triangle[0]];
  const Vec3d normal = cross(points[triangle[1]] - a, points[triangle[2]] - a);
  const double size = length(normal);
  return size > 0 ? (1 / size) * normal : Vec3d{};
}

/// Sets of corners [3 triangle + corner] that share a point: corners at a node that are connected across
/// edges that bend little.
DisjointSets smooth_corners(const std::vector<Triangle>& triangles, const std::vector<Vec3d>& start) {
  const double least_cosine = std::cos(40 * std::numbers::pi / 180);
  DisjointSets corners(3 * triangles.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_at;  // first triangle of each edge
  const auto corner_at = [&](std::uint32_t triangle, std::uint32_t node) {
    const auto& nodes = triangles[triangle];
    return 3 * triangle + static_cast<std::uint32_t>(std::ranges::find(nodes, node) - nodes.begin());
  };
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
      const auto [found, is_first] = first_at.try_emplace({low, high}, t);
      const std::uint32_t other = found->second;
      if (is_first || dot(normal_of(triangles[t], start), normal_of(triangles[other], start)) < least_cosine)
        continue;
      for (const std::uint32_t node : {low, high}) corners.unite(corner_at(t, node), corner_at(other, node));
    }
  return corners;
}

/// Makes one point for each smooth side of a node.
void divide_at_creases(NodeSurface& skin, const std::vector<Vec3d>& start) {
  const auto position = mapped<Vec3d>(skin.node, [&](std::uint32_t node) { return start[node]; });
  DisjointSets corners = smooth_corners(skin.triangles, position);
  std::vector<std::uint32_t> node, part, point(3 * skin.triangles.size());
  for (std::uint32_t corner = 0; corner < point.size(); ++corner) {
    std::uint32_t& shown = skin.triangles[corner / 3][corner % 3];
    if (corners.root(corner) == corner) {
      point[corner] = static_cast<std::uint32_t>(node.size());
      node.push_back(skin.node[shown]);
      part.push_back(skin.part[shown]);
    }
    shown = point[corners.root(corner)];
  }
  skin.node = std::move(node);
  skin.part = std::move(part);
}

constexpr Rgb skin_tone{201, 188, 178}, denim{58, 88, 140};

/// Colour of the back: paler.
Light inside_of(const Light& colour) {
  constexpr float kept = 0.72F;
  return kept * colour + (1 - kept) * Light{0.55F, 0.55F, 0.55F};
}

std::vector<Rgb> part_colours(const NodeShape& shape, const NodeSurface& skin, ColourBy colour) {
  const bool by_layer = shape.in_panels && colour != ColourBy::panel;
  const auto& categories = category_colours();
  std::vector<Rgb> colours;
  for (std::size_t part = 0; part < skin.parts.size(); ++part) {
    const std::size_t object = by_layer ? shape.sheets[part].layer : part;
    // A single object looks like denim; several need different colours.
    colours.push_back(
        object == 0 && (skin.parts.size() == 1 || by_layer) ? denim : categories[object % categories.size()]);
  }
  return colours;
}

/// Bound of the absolute strain of all but the most strained fiftieth of the nodes.
double usual_most(std::vector<double> strain) {
  for (double& value : strain) value = std::abs(value);
  const auto place = strain.begin() + static_cast<std::ptrdiff_t>(strain.size() * 49 / 50);
  std::ranges::nth_element(strain, place);
  return *place;
}

}  // namespace

NodeSurface skin_of(const NodeShape& shape, const std::vector<Vec3d>& start) {
  NodeSurface skin = surface_of(shape, start.size());
  if (!shape.tetrahedra.empty()) divide_at_creases(skin, start);
  return skin;
}

Painter::Painter(const TraceContent& content, const std::vector<Vec3d>& start, const PictureOptions& options)
    : content_(content),
      options_(options),
      camera_(options.view),
      skin_(skin_of(content.shape, start)),
      colour_(part_colours(content.shape, skin_, options.colour)),
      floor_(stated_floor(content.scene_json)) {}

std::vector<Vec3d> Painter::points_at(const std::vector<Vec3d>& positions) const {
  auto points = mapped<Vec3d>(skin_.node, [&](std::uint32_t node) { return positions[node]; });
  points.insert(points.end(), content_.body.points.begin(), content_.body.points.end());
  return points;
}

void Painter::make_room_for(const std::vector<Vec3d>& positions) {
  std::vector<Vec3d> points = points_at(positions);
  const auto unite = [this](std::optional<Box<double>>& box, const std::vector<Vec3d>& with) {
    const Box<double> seen = seen_box(camera_, with);
    box = box ? united(*box, seen) : seen;
  };
  unite(seen_, points);
  if (!world_) world_ = {points.front(), points.front()};
  for (const Vec3d& point : points) extend(*world_, point);
  const Vec3d light = shadow_light(options_.view);
  for (Vec3d& point : points) point = point - (point.y / light.y) * light;
  unite(shadow_, points);
  if (options_.colour == ColourBy::strain)
    most_strain_ = std::max(most_strain_, usual_most(node_strain(content_, positions)));
}

bool Painter::has_legend() const {
  return options_.colour == ColourBy::strain ||
         (options_.colour == ColourBy::panel && content_.shape.in_panels && skin_.parts.size() > 1 &&
          skin_.parts.size() <= category_colours().size());
}

Picture Painter::legend() const {
  Picture picture(options_.width, options_.height);
  write_legend(picture);
  return picture;
}

void Painter::write_legend(Picture& picture) const {
  if (!has_legend()) return;
  constexpr double percent = 100;
  if (options_.colour == ColourBy::strain) {
    draw_colour_bar(picture, -percent * most_strain_, percent * most_strain_, "strain in %");
    return;
  }
  std::vector<LegendEntry> entries;
  for (std::size_t part = 0; part < skin_.parts.size(); ++part)
    entries.push_back({colour_[part], skin_.parts[part]});
  draw_legend(picture, entries);
}

Shot Painter::shot() const {
  // The ground is slightly below the lowest point, so that neither shows through the other.
  constexpr double gap = 0.003, far = 1.0;  // of the largest extent
  const Vec3d size = world_->size();
  const double extent = std::max({size.x, size.y, size.z});
  const bool near_floor = floor_ && *floor_ <= world_->low.y && world_->low.y - *floor_ < far * extent;
  const double height = (near_floor ? *floor_ : world_->low.y) - gap * extent;
  const Ground ground(*world_, height);
  Box<double> seen = *seen_;
  if (ground.met_by(camera_, 0, 0)) {
    const Vec3d light = shadow_light(options_.view);
    const Vec3d moved = camera_.seen((height / light.y) * light);
    seen = united(seen, {shadow_->low + moved, shadow_->high + moved});
  }
  return {options_.view, options_.width, options_.height, seen, ground, options_.threads};
}

Picture Painter::picture_of(const std::vector<Vec3d>& positions, bool with_legend) const {
  Subject subject{{points_at(positions), skin_.triangles}, {}, {}};
  subject.front.reserve(subject.surface.points.size());
  if (options_.colour == ColourBy::strain) {
    const std::vector<double> strain = node_strain(content_, positions);
    for (const std::uint32_t node : skin_.node)
      subject.front.push_back(light_of(diverging_colour(0.5 + 0.5 * strain[node] / most_strain_)));
    subject.back = subject.front;
  } else {
    const auto colour = mapped<Light>(colour_, light_of);  // by part: a skin has many more points
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
  if (with_legend) write_legend(picture);
  return picture;
}

PictureFolder::PictureFolder(std::filesystem::path folder, TraceContent content,
                             const PictureOptions& options)
    : folder_(std::move(folder)),
      lock_(lock_folder(make_folder(folder_))),
      content_(std::move(content)),
      options_(options) {
  if (!std::filesystem::is_empty(folder_))
    throw UsageError("cannot put pictures into {}, which is not empty; empty it or choose another folder",
                     folder_.string());
}

void PictureFolder::draw(const std::vector<Vec3d>& positions) {
  if (!painter_) painter_.emplace(content_, positions, options_);
  painter_->make_room_for(positions);
  // So many digits that listings are in order.
  write_file_atomically(folder_ / fmt::format("frame-{:06}.png", pictures_++),
                        png_of(painter_->picture_of(positions)));
}

}  // namespace mssim
